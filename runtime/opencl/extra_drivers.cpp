#include "runtime/opencl/extra_drivers.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "runtime/split.h"

namespace weft {

namespace {

namespace fs = std::filesystem;

constexpr const char* kVendors = "OCL_ICD_VENDORS";
constexpr const char* kNvidia = "libnvidia-opencl.so.1";

/// Of a list as in PATH.
std::vector<std::string> listed(const std::string& text) {
    std::vector<std::string> parts = split(text, ':');
    std::erase(parts, "");
    return parts;
}

std::vector<fs::path> registration_files(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
        if (entry.path().extension() == ".icd") files.push_back(entry.path());
    }
    return files;
}

/// "libpocl" of "/usr/lib/libpocl.so.2.10.0"
std::string driver_name(const std::string& library) {
    const std::string name = fs::path(library).filename().string();
    return name.substr(0, name.find(".so"));
}

std::vector<std::string> registered_names(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::path& file : registration_files(folder)) {
        std::string library;
        std::getline(std::ifstream(file), library);
        names.push_back(driver_name(library));
    }
    return names;
}

/// In the first place where that is possible: a bare container has no /tmp.
fs::path make_temporary_folder() {
    const char* own = std::getenv("TMPDIR");
    for (const char* place : {own != nullptr ? own : "/tmp", "/tmp", "/dev/shm", "/var/tmp", "."}) {
        std::string name = std::string(place) + "/weft-drivers-XXXXXX";
        if (::mkdtemp(name.data()) != nullptr) return fs::absolute(name);
    }
    return {};
}

}  // namespace

DriverPlaces usual_driver_places() {
    DriverPlaces places;
    if (const char* wanted = std::getenv("WEFT_OPENCL_DRIVERS")) places.wanted = wanted;
    if (const char* own = std::getenv("LD_LIBRARY_PATH")) {
        for (const std::string& folder : listed(own)) places.libraries.emplace_back(folder);
    }
    for (const char* folder :
         {"/usr/lib/x86_64-linux-gnu", "/usr/lib/aarch64-linux-gnu", "/usr/lib64", "/usr/lib",
          "/usr/local/nvidia/lib64", "/usr/lib/x86_64-linux-gnu/nvidia/current", "/usr/lib/wsl/lib",
          "/run/opengl-driver/lib", "/.singularity.d/libs"}) {
        places.libraries.emplace_back(folder);
    }
    return places;
}

std::vector<std::string> unregistered_drivers(const DriverPlaces& places) {
    std::vector<std::string> drivers = listed(places.wanted);
    const auto nvidia = std::ranges::find_if(
        places.libraries, [](const fs::path& folder) { return fs::exists(folder / kNvidia); });
    if (nvidia != places.libraries.end()) drivers.push_back((*nvidia / kNvidia).string());

    const auto registered = registered_names(places.registrations);
    std::erase_if(drivers, [&](const std::string& library) {
        return !fs::exists(library) ||
               std::ranges::find(registered, driver_name(library)) != registered.end();
    });
    return drivers;
}

ExtraDrivers::ExtraDrivers(const DriverPlaces& places) {
    if (std::getenv(kVendors) != nullptr || std::getenv("OPENCL_VENDOR_PATH") != nullptr) return;
    const auto drivers = unregistered_drivers(places);
    if (drivers.empty()) return;
    folder_ = make_temporary_folder();
    if (folder_.empty()) return;
    for (const fs::path& file : registration_files(places.registrations)) {
        fs::copy_file(file, folder_ / file.filename());
    }
    for (const std::string& library : drivers) {
        std::ofstream(folder_ / ("weft-" + driver_name(library) + ".icd")) << library << '\n';
    }
    ::setenv(kVendors, folder_.c_str(), /*overwrite=*/1);
}

ExtraDrivers::~ExtraDrivers() {
    if (folder_.empty()) return;
    ::unsetenv(kVendors);
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
}

}  // namespace weft
