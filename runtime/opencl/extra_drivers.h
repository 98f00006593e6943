#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace weft {

/// Where drivers are looked for.
struct DriverPlaces {
    std::string wanted;  ///< library files, with colons between
    std::filesystem::path registrations = "/etc/OpenCL/vendors";
    std::vector<std::filesystem::path> libraries;  ///< folders
};

/// Those of this machine: $WEFT_OPENCL_DRIVERS, and where NVIDIA's driver lies in containers, on
/// clusters, under WSL.
DriverPlaces usual_driver_places();

/// Library files of OpenCL drivers that are there, but that no .icd file registers: the wanted
/// ones, and NVIDIA's. A driver counts as registered if one of the same name is, whatever its
/// version: two copies of one driver in one process do not get along.
std::vector<std::string> unregistered_drivers(const DriverPlaces& places);

/// While it lives, the OpenCL loader finds these drivers beside the registered ones, if it has not
/// been asked for platforms before. It looks only once, into one folder, so this is a folder of
/// registrations of its own in $OCL_ICD_VENDORS. Does nothing where there is no such driver, or
/// where the user has set that variable.
class ExtraDrivers {
public:
    explicit ExtraDrivers(const DriverPlaces& places);
    ~ExtraDrivers();
    ExtraDrivers(const ExtraDrivers&) = delete;
    ExtraDrivers& operator=(const ExtraDrivers&) = delete;

private:
    std::filesystem::path folder_;  ///< empty: nothing to do
};

}  // namespace weft
