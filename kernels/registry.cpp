#include "kernels/registry.h"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "kernels/sources.h"

namespace weft::kernels {

namespace {

bool can_run(Target target) {
#if defined(__x86_64__)
    if (target == Target::kPackedAvx2) return __builtin_cpu_supports("avx2");
    if (target == Target::kPackedAvx512) {
        return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
               __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512bw");
    }
#endif
    return target < Target::kPackedAvx2;
}

int lanes_of(Target target) { return target == Target::kPackedAvx512 ? 16 : 8; }

struct Registry {
    std::map<std::string, KernelInfo> kernels;
    std::vector<SourceFile> sources;  ///< ordered by path, the language's included
};

Registry& registry() {
    static Registry instance{{}, {language_sources().begin(), language_sources().end()}};
    return instance;
}

/// "/anywhere/kernels/xpbd/springs.h" -> "kernels/xpbd/springs.h"
std::string_view from_project_root(std::string_view file) {
    const std::size_t at = file.rfind("kernels/");
    return at == std::string_view::npos ? file : file.substr(at);
}

/// The last component of a path, without those before it.
std::string_view take_last(std::string_view& path) {
    const std::size_t slash = path.rfind('/');
    const std::string_view last = slash == std::string_view::npos ? path : path.substr(slash + 1);
    path = slash == std::string_view::npos ? std::string_view() : path.substr(0, slash);
    return last;
}

/// How many components at their ends are the same.
int common_tail(std::string_view a, std::string_view b) {
    int common = 0;
    while (!a.empty() && !b.empty() && take_last(a) == take_last(b)) ++common;
    return common;
}

}  // namespace

bool add_kernel(const std::string& name, KernelInfo info) {
    KernelInfo& known = registry().kernels[name];
    info.scalar = known.scalar;
    info.packed_forms = known.packed_forms;
    if (info.space.empty()) info.file = from_project_root(info.file);
    known = std::move(info);
    return true;
}

bool add_range_function(Target target, const std::string& name, RangeFunction function) {
    KernelInfo& info = registry().kernels[name];
    if (target == Target::kScalar) {
        info.scalar = function;
        return true;
    }
    if (!can_run(target)) return true;
    info.packed_forms[target] = function;
    return true;
}

int widest_pack() { return can_run(Target::kPackedAvx512) ? 16 : 8; }

RangeFunction KernelInfo::form(int lanes) const {
    if (lanes == 1) return scalar;
    RangeFunction best = nullptr;
    for (const auto& [target, function] : packed_forms) {
        if (lanes_of(target) <= lanes) best = function;
    }
    return best;
}

const KernelInfo& kernel_info(const std::string& name) {
    const auto& kernels = registry().kernels;
    const auto found = kernels.find(name);
    if (found == kernels.end() || found->second.scalar == nullptr) {
        throw std::logic_error("kernel '" + name +
                               "' has not been compiled: give its header to weft_add_kernels()");
    }
    return found->second;
}

std::vector<const KernelInfo*> all_kernels() {
    std::vector<const KernelInfo*> list;
    for (const auto& [name, info] : registry().kernels) list.push_back(&info);
    return list;
}

bool add_sources(std::span<const SourceFile> files) {
    auto& sources = registry().sources;
    sources.insert(sources.end(), files.begin(), files.end());
    std::ranges::sort(sources, {}, &SourceFile::path);
    const auto same = [](const SourceFile& a, const SourceFile& b) {
        return a.path == b.path && a.text == b.text;
    };
    sources.erase(std::unique(sources.begin(), sources.end(), same), sources.end());
    return true;
}

std::span<const SourceFile> source_files() { return registry().sources; }

const SourceFile* find_source(std::string_view path) {
    const SourceFile* best = nullptr;
    int most = 0;
    for (const SourceFile& file : registry().sources) {
        const int common = common_tail(file.path, path);
        if (common <= most) continue;
        most = common;
        best = &file;
    }
    return best;
}

const SourceFile* find_included(std::string_view name) {
    const SourceFile* file = find_source(name);
    const auto wanted = 1 + static_cast<int>(std::ranges::count(name, '/'));
    return file != nullptr && common_tail(file->path, name) == wanted ? file : nullptr;
}

}  // namespace weft::kernels
