#include "simulation/scene/method.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace weft {

namespace {

struct Entry {
    Method method;
    const char* name;
    bool is_vertex_wise;
};

constexpr Entry kMethods[] = {
    {Method::kXpbd, "xpbd", false},    {Method::kVbd, "vbd", true},
    {Method::kSosd, "sosd", true},     {Method::kJpgd, "jpgd", false},
    {Method::kNewton, "newton", true},
};

const Entry& entry_of(Method method) {
    return *std::find_if(std::begin(kMethods), std::end(kMethods),
                         [&](const Entry& entry) { return entry.method == method; });
}

}  // namespace

std::vector<std::string> method_names() {
    std::vector<std::string> names;
    for (const Entry& entry : kMethods) names.emplace_back(entry.name);
    return names;
}

std::string_view name_of(Method method) { return entry_of(method).name; }

Method method_named(std::string_view name) {
    for (const Entry& entry : kMethods) {
        if (entry.name == name) return entry.method;
    }
    throw std::logic_error("no solver is called '" + std::string(name) + "'");
}

bool is_vertex_wise(Method method) { return entry_of(method).is_vertex_wise; }

}  // namespace weft
