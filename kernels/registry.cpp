#include "kernels/registry.h"

#include <map>
#include <stdexcept>
#include <string>

namespace weft::kernels {

// Defined beside the kernels of each target: calling them makes the linker keep those files.
void link_scalar_kernels();
void link_packed_kernels();
#ifdef WEFT_HAS_AVX2_KERNELS
void link_packed_avx2_kernels();
#endif

namespace {

bool can_run(Target target) {
#ifdef WEFT_HAS_AVX2_KERNELS
    if (target == Target::kPackedAvx2) return __builtin_cpu_supports("avx2");
#endif
    return target != Target::kPackedAvx2;
}

struct Registry {
    std::map<std::string_view, KernelInfo> kernels;
    std::map<std::string_view, Target> packed_target;  ///< which target `packed` came from
};

Registry& registry() {
    static Registry instance;
    return instance;
}

const Registry& complete_registry() {
    link_scalar_kernels();
    link_packed_kernels();
#ifdef WEFT_HAS_AVX2_KERNELS
    link_packed_avx2_kernels();
#endif
    return registry();
}

/// "/anywhere/kernels/xpbd/springs.h" -> "kernels/xpbd/springs.h"
std::string_view from_project_root(std::string_view file) {
    const std::size_t at = file.rfind("kernels/");
    return at == std::string_view::npos ? file : file.substr(at);
}

}  // namespace

bool add_kernel(std::string_view name, std::string_view file, std::vector<Parameter> parameters) {
    KernelInfo& info = registry().kernels[name];
    info.name = name;
    info.file = from_project_root(file);
    info.parameters = std::move(parameters);
    return true;
}

bool add_range_function(Target target, std::string_view name, RangeFunction function) {
    KernelInfo& info = registry().kernels[name];
    if (target == Target::kScalar) {
        info.scalar = function;
        return true;
    }
    auto [known, is_new] = registry().packed_target.try_emplace(name, target);
    if (can_run(target) && (is_new || target > known->second)) {
        known->second = target;
        info.packed = function;
    } else if (is_new) {
        registry().packed_target.erase(known);
    }
    return true;
}

const KernelInfo& kernel_info(std::string_view name) {
    const auto& kernels = complete_registry().kernels;
    const auto found = kernels.find(name);
    if (found == kernels.end()) throw std::logic_error("no kernel '" + std::string(name) + "'");
    return found->second;
}

std::vector<const KernelInfo*> all_kernels() {
    std::vector<const KernelInfo*> list;
    for (const auto& [name, info] : complete_registry().kernels) list.push_back(&info);
    return list;
}

}  // namespace weft::kernels
