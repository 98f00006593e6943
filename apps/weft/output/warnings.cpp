#include "apps/weft/output/warnings.h"

#include <fmt/format.h>

#include <iostream>

#include "runtime/io/cache_folder.h"

namespace weft {

std::string text_of(const Trouble& trouble) {
    return fmt::format("frame {}: {}", trouble.frame, trouble.what);
}

std::string text_of(const LostDevice& lost, const Simulation& simulation) {
    const auto& device = simulation.devices()[static_cast<std::size_t>(lost.device)];
    return fmt::format("device {} ({}) was lost in frame {}, the others go on without it: {}",
                       lost.device, device->info().name, lost.frame, lost.why);
}

void print_warnings(const Warnings& warnings) {
    for (const std::string& warning : warnings) std::cerr << "weft: warning: " << warning << '\n';
}

void warn_of_cache_folder() {
    const std::string trouble = cache_folder_trouble();
    if (!trouble.empty()) print_warnings({trouble});
}

}  // namespace weft
