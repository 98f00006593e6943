#include "simulation/description/versions.h"

#include <fmt/format.h>
#include <libdeflate.h>
#include <toml++/toml.h>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace weft {

namespace {

std::string version(int major, int minor, int patch) {
    return fmt::format("{}.{}.{}", major, minor, patch);
}

}  // namespace

TextPairs simulation_versions() {
    return {{"eigen", version(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
            {"fmt", version(FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
            {"json", version(NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                             NLOHMANN_JSON_VERSION_PATCH)},
            {"libdeflate", LIBDEFLATE_VERSION_STRING},
            {"tomlplusplus", version(TOML_LIB_MAJOR, TOML_LIB_MINOR, TOML_LIB_PATCH)}};
}

}  // namespace weft
