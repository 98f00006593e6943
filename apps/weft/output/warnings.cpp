#include "apps/weft/output/warnings.h"

#include <iostream>

#include "runtime/io/cache_folder.h"

namespace weft {

void print_warnings(const Warnings& warnings) {
    for (const std::string& warning : warnings) std::cerr << "weft: warning: " << warning << '\n';
}

void warn_of_cache_folder() {
    const std::string trouble = cache_folder_trouble();
    if (!trouble.empty()) print_warnings({trouble});
}

}  // namespace weft
