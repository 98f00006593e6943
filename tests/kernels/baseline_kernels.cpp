// All kernels once more, packed, without the library's flags for better instructions, and without
// registering them there.

#define WEFT_PACKED_TARGET packed_for_tests
#include "kernels/platform.h"

#include <map>

namespace weft::test {
namespace {

std::map<std::string_view, kernels::RangeFunction>& forms() {
    static std::map<std::string_view, kernels::RangeFunction> instance;
    return instance;
}

template <class Kernel>
bool note() {
    const kernels::RangeFunction function = &kernels::run_range<Kernel>;
    return forms().emplace(Kernel::kName, function).second;
}

}  // namespace
}  // namespace weft::test

#undef WEFT_REGISTER
#define WEFT_REGISTER(kernel) weft::test::note<kernel>()
#include "all_kernels.h"  // written by CMake

#include "tests/kernels/baseline_kernels.h"

namespace weft::test {

kernels::RangeFunction baseline_packed(std::string_view kernel) {
    const auto found = forms().find(kernel);
    return found == forms().end() ? nullptr : found->second;
}

}  // namespace weft::test
