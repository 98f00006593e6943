#include "apps/weft/output/warnings.h"

#include <iostream>

namespace weft {

void print_warnings(const Warnings& warnings) {
    for (const std::string& warning : warnings) std::cerr << "weft: warning: " << warning << '\n';
}

}  // namespace weft
