#pragma once

#include <cstdio>
#include <cstdlib>

/// WEFT_ASSERT(condition) ends the program where an invariant of Weft's own does not hold. Alive in
/// builds with WEFT_VALIDATE (the preset `validate`, and CI); elsewhere it costs nothing, and the
/// condition is only compiled. What users can get wrong is no matter for it: that is a UserError.
#ifdef WEFT_VALIDATE
#define WEFT_ASSERT(condition) \
    ((condition) ? void() : weft::assertion_failed(#condition, __FILE__, __LINE__))
#else
#define WEFT_ASSERT(condition) static_cast<void>(sizeof(!(condition)))
#endif

namespace weft {

[[noreturn]] inline void assertion_failed(const char* condition, const char* file, int line) {
    std::fprintf(stderr, "%s:%d: the invariant does not hold: %s\n", file, line, condition);
    std::abort();
}

}  // namespace weft
