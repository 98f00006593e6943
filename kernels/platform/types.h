#pragma once

// C++ only: what both C++ targets share.

#include "kernels/registry.h"

namespace weft {

/// As OpenCL's float4: 16 bytes, 16-byte aligned.
struct alignas(16) float4 {
    float x, y, z, w;
};

}  // namespace weft

#define WEFT_GLOBAL
#define WEFT_INLINE inline __attribute__((always_inline))
#define WEFT_KERNELS_BEGIN    \
    namespace weft::kernels { \
    inline namespace WEFT_TARGET {
/// The same in a namespace of one's own: kernels of other projects do not meet then.
#define WEFT_KERNELS_IN(space)       \
    namespace space {                \
    inline namespace WEFT_TARGET {   \
    using namespace ::weft::kernels; \
    using ::weft::float4;            \
    using kernel_space = ::weft::kernels::KernelSpace<#space "::">;
#define WEFT_KERNELS_END \
    }                    \
    }

/// Defines a kernel: WEFT_KERNEL(name, parameters...) { body for item i }.
/// `weft::kernels::name` is then a constant whose type carries the signature, for typed launches.
#define WEFT_KERNEL(name, ...) \
    WEFT_DEFINE_KERNEL(WEFT_REGISTRATION, name, #__VA_ARGS__, __VA_ARGS__)
#define WEFT_NARROW_KERNEL(name, ...) \
    WEFT_DEFINE_KERNEL(WEFT_NARROW_REGISTRATION, name, #__VA_ARGS__, __VA_ARGS__)

/// text: of the parameters as they are written, which is lost where a macro hands them on.
#define WEFT_DEFINE_KERNEL(registration, name, text, ...)          \
    struct name##_kernel {                                         \
        static constexpr const char* kName = #name;                \
        static constexpr const char* kSpace = kernel_space::kName; \
        static constexpr const char* kFile = __FILE__;             \
        static constexpr const char* kParameters = text;           \
        static constexpr int kLaneCount = kLanes;                  \
        using Item = item;                                         \
        static inline void run(item i, __VA_ARGS__);               \
    };                                                             \
    inline constexpr name##_kernel name{};                         \
    registration(name) WEFT_INLINE void name##_kernel::run(item i, __VA_ARGS__)
