#include "runtime/io/hdf5/files.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "runtime/io/whole_file.h"

namespace weft::hdf5 {

namespace {

/// Locks would keep readers out of a running simulation's files, and fail on some network disks.
/// Two writers cannot meet: each creates its file anew.
void switch_locking_off(hid_t access) {
#if H5_VERSION_GE(1, 10, 7)
    check(H5Pset_file_locking(access, false, true), "set up file access");
#else
    (void)access;
#endif
}

Handle file_access() {
    Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "set up file access");
    switch_locking_off(access.id());
    return access;
}

#if H5_VERSION_GE(1, 10, 2)
constexpr H5F_libver_t kFormat110 = H5F_LIBVER_V110;
constexpr H5F_libver_t kFormat18 = H5F_LIBVER_V18;
#else
constexpr H5F_libver_t kFormat110 = H5F_LIBVER_LATEST;
constexpr H5F_libver_t kFormat18 = H5F_LIBVER_EARLIEST;
#endif

}  // namespace

Handle create_file(const std::string& path, FileFormat format, std::size_t chunks) {
    if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path)) {
        throw Error("create: there is something of that name that is not a file");
    }
    const std::filesystem::path part = unfinished(path);
    std::filesystem::remove(part);
    const Handle access = file_access();
    const auto oldest = format == FileFormat::kSwmr ? kFormat110 : kFormat18;
    check(H5Pset_libver_bounds(access.id(), oldest, kFormat110), "set the file's format");
    const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "set the file's format");
    check(H5Pset_istore_k(creation.id(), static_cast<unsigned>((chunks + 1) / 2)),
          "set the file's format");
    return {H5Fcreate(part.c_str(), H5F_ACC_TRUNC, creation.id(), access.id()), H5Fclose, "create"};
}

void publish(const std::string& path) {
    if (std::rename(unfinished(path).c_str(), path.c_str()) != 0) {
        throw Error(std::string("create: ") + std::strerror(errno));
    }
}

Handle open_to_read(const std::string& path) {
    const Handle access = file_access();
    const hid_t plain = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id());
    if (plain >= 0) return {plain, H5Fclose, "open"};
    H5Eclear2(H5E_DEFAULT);
    return {H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, access.id()), H5Fclose,
            "open"};
}

Handle open_whole(const std::string& path) {
    const Handle access = file_access();
    return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id()), H5Fclose, "open"};
}

Handle open_to_modify(const std::string& path) {
    const Handle access = file_access();
    return {H5Fopen(path.c_str(), H5F_ACC_RDWR, access.id()), H5Fclose, "open"};
}

Handle create_group(hid_t parent, const std::string& name) {
    return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose,
            "create group '" + name + "'"};
}

void link_external(hid_t parent, const std::string& name, const std::string& path) {
    check(H5Lcreate_external(path.c_str(), "/", parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT),
          "link '" + name + "'");
}

bool exists(hid_t parent, const std::string& name) {
    return H5Lexists(parent, name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> dataset_paths(hid_t file) {
    std::vector<std::string> paths;
    const auto note = [](hid_t, const char* name, const H5L_info_t* link, void* data) -> herr_t {
        if (link->type != H5L_TYPE_HARD) return 0;
        static_cast<std::vector<std::string>*>(data)->push_back(std::string("/") + name);
        return 0;
    };
    check(H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, note, &paths), "list datasets");
    std::erase_if(paths, [&](const std::string& path) {
        const Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose, "list datasets");
        return H5Iget_type(object.id()) != H5I_DATASET;
    });
    return paths;
}

}  // namespace weft::hdf5
