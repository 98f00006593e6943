#include "runtime/io/hdf5.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "runtime/io/whole_file.h"

namespace weft::hdf5 {

namespace {

std::recursive_mutex& library_mutex() {
    static std::recursive_mutex mutex;
    return mutex;
}

/// The library reports a failed system call as "..., errno = 28, error message = '...', ...".
std::string system_reason(const std::string& description) {
    constexpr std::string_view kMark = "error message = '";
    const std::size_t begin = description.find(kMark);
    if (begin == std::string::npos) return {};
    const std::size_t end = description.find('\'', begin + kMark.size());
    return description.substr(begin + kMark.size(), end - begin - kMark.size());
}

struct Reason {
    std::string innermost;
    std::string system;
};

herr_t note_reason(unsigned, const H5E_error2_t* error, void* data) {
    auto& reason = *static_cast<Reason*>(data);
    if (!error->desc) return 0;
    if (reason.innermost.empty()) reason.innermost = error->desc;
    if (reason.system.empty()) reason.system = system_reason(error->desc);
    return 0;
}

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

Handle scalar_space() { return {H5Screate(H5S_SCALAR), H5Sclose, "create a dataspace"}; }

/// Of the file that an object is in.
std::string name_of_file(hid_t object) {
    const ssize_t length = H5Fget_name(object, nullptr, 0);
    if (length < 0) fail("read a file's name");
    std::string name(static_cast<std::size_t>(length), '\0');
    H5Fget_name(object, name.data(), name.size() + 1);
    return name;
}

/// An attribute that is there already is of the same type: Weft's files change values only.
Handle create_attribute(hid_t object, const std::string& name, hid_t type, hid_t space) {
    const std::string what = "write attribute '" + name + "'";
    if (H5Aexists(object, name.c_str()) > 0) {
        return {H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, what};
    }
    return {H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
            what};
}

Handle open_attribute(hid_t object, const std::string& name) {
    return {H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "read attribute '" + name + "'"};
}

Handle string_type_like(hid_t stored, const std::string& what) {
    if (H5Tget_class(stored) != H5T_STRING || H5Tis_variable_str(stored) <= 0) {
        throw Error(what + ": it is not text of variable length");
    }
    return string_type();
}

}  // namespace

Session::Session() : lock_(library_mutex()) {
    // Handles close themselves; what is still open at the process's end was abandoned on purpose.
    [[maybe_unused]] static const herr_t no_exit_handler = H5dont_atexit();
    H5Eget_auto2(H5E_DEFAULT, &printer_, &printer_data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Session::~Session() { H5Eset_auto2(H5E_DEFAULT, printer_, printer_data_); }

void fail(std::string_view what) {
    Reason reason;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, note_reason, &reason);
    H5Eclear2(H5E_DEFAULT);
    const std::string& why = reason.system.empty() ? reason.innermost : reason.system;
    throw Error(std::string(what) + (why.empty() ? "" : ": " + why));
}

Handle& Handle::operator=(Handle&& other) noexcept {
    if (this != &other) {
        reset();
        id_ = std::exchange(other.id_, H5I_INVALID_HID);
        closer_ = other.closer_;
    }
    return *this;
}

void Handle::reset() noexcept {
    if (id_ < 0) return;
    const Session session;
    closer_(std::exchange(id_, H5I_INVALID_HID));
}

void Handle::close(std::string_view what) {
    if (id_ >= 0) check(closer_(std::exchange(id_, H5I_INVALID_HID)), what);
}

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

Handle string_type() {
    Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "create a text type");
    check(H5Tset_size(type.id(), H5T_VARIABLE), "create a text type");
    check(H5Tset_cset(type.id(), H5T_CSET_UTF8), "create a text type");
    return type;
}

Handle bool_type() {
    Handle type(H5Tenum_create(H5T_NATIVE_INT8), H5Tclose, "create a bool type");
    const signed char no = 0;
    const signed char yes = 1;
    check(H5Tenum_insert(type.id(), "FALSE", &no), "create a bool type");
    check(H5Tenum_insert(type.id(), "TRUE", &yes), "create a bool type");
    return type;
}

void write_text_attribute(hid_t object, const std::string& name, const std::string& value) {
    const Handle type = string_type();
    const Handle space = scalar_space();
    const Handle attribute = create_attribute(object, name, type.id(), space.id());
    const char* text = value.c_str();
    check(H5Awrite(attribute.id(), type.id(), &text), "write attribute '" + name + "'");
}

void write_bool_attribute(hid_t object, const std::string& name, bool value) {
    const Handle type = bool_type();
    const Handle space = scalar_space();
    const Handle attribute = create_attribute(object, name, type.id(), space.id());
    const signed char byte = value ? 1 : 0;
    check(H5Awrite(attribute.id(), type.id(), &byte), "write attribute '" + name + "'");
}

void write_int_attribute(hid_t object, const std::string& name, std::span<const int> values) {
    const hsize_t count = values.size();
    const Handle space =
        count == 1 ? scalar_space()
                   : Handle(H5Screate_simple(1, &count, nullptr), H5Sclose, "create a dataspace");
    const Handle attribute = create_attribute(object, name, H5T_NATIVE_INT, space.id());
    check(H5Awrite(attribute.id(), H5T_NATIVE_INT, values.data()),
          "write attribute '" + name + "'");
}

void write_texts_attribute(hid_t object, const std::string& name,
                           const std::vector<std::string>& values) {
    std::vector<const char*> texts;
    for (const std::string& value : values) texts.push_back(value.c_str());
    const hsize_t count = texts.size();
    const Handle type = string_type();
    const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose, "create a dataspace");
    const Handle attribute = create_attribute(object, name, type.id(), space.id());
    check(H5Awrite(attribute.id(), type.id(), texts.data()), "write attribute '" + name + "'");
}

std::string read_text_attribute(hid_t object, const std::string& name) {
    const std::string what = "read attribute '" + name + "'";
    const Handle attribute = open_attribute(object, name);
    const Handle stored(H5Aget_type(attribute.id()), H5Tclose, what);
    const Handle type = string_type_like(stored.id(), what);
    char* text = nullptr;
    check(H5Aread(attribute.id(), type.id(), &text), what);
    std::string value = text ? text : "";
    H5free_memory(text);
    return value;
}

bool read_bool_attribute(hid_t object, const std::string& name) {
    const Handle attribute = open_attribute(object, name);
    const Handle type = bool_type();
    signed char value = 0;
    check(H5Aread(attribute.id(), type.id(), &value), "read attribute '" + name + "'");
    return value != 0;
}

int read_int_attribute(hid_t object, const std::string& name) {
    const Handle attribute = open_attribute(object, name);
    int value = 0;
    check(H5Aread(attribute.id(), H5T_NATIVE_INT, &value), "read attribute '" + name + "'");
    return value;
}

std::vector<std::string> attribute_names(hid_t object) {
    std::vector<std::string> names;
    const auto note = [](hid_t, const char* name, const H5A_info_t*, void* data) -> herr_t {
        static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        return 0;
    };
    check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, note, &names),
          "list attributes");
    return names;
}

void write_text(hid_t parent, const std::string& name, const std::string& value) {
    const std::string what = "write dataset '" + name + "'";
    const Handle type = string_type();
    const Handle space = scalar_space();
    const Handle dataset(H5Dcreate2(parent, name.c_str(), type.id(), space.id(), H5P_DEFAULT,
                                    H5P_DEFAULT, H5P_DEFAULT),
                         H5Dclose, what);
    const char* text = value.c_str();
    check(H5Dwrite(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &text), what);
}

void write_texts(hid_t parent, const std::string& name, const std::vector<std::string>& values) {
    std::vector<const char*> texts;
    for (const std::string& value : values) texts.push_back(value.c_str());
    const Handle type = string_type();
    const hsize_t shape[] = {texts.size()};
    write_array(parent, name, type.id(), shape, texts.data());
}

std::string read_text(hid_t parent, const std::string& name) {
    const std::string what = "read dataset '" + name + "'";
    const Handle dataset = open_dataset(parent, name);
    const Handle stored(H5Dget_type(dataset.id()), H5Tclose, what);
    const Handle type = string_type_like(stored.id(), what);
    char* text = nullptr;
    check(H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &text), what);
    std::string value = text ? text : "";
    H5free_memory(text);
    return value;
}

std::vector<std::string> read_texts(hid_t parent, const std::string& name) {
    const std::string what = "read dataset '" + name + "'";
    const Handle dataset = open_dataset(parent, name);
    const Handle stored(H5Dget_type(dataset.id()), H5Tclose, what);
    const Handle type = string_type_like(stored.id(), what);
    const Handle space(H5Dget_space(dataset.id()), H5Sclose, what);
    std::vector<char*> texts(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space.id())));
    if (texts.empty()) return {};
    check(H5Dread(dataset.id(), type.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, texts.data()), what);
    std::vector<std::string> values;
    for (char* text : texts) {
        values.emplace_back(text ? text : "");
        H5free_memory(text);
    }
    return values;
}

Handle write_array(hid_t parent, const std::string& name, hid_t type,
                   std::span<const hsize_t> shape, const void* values) {
    const std::string what = "write dataset '" + name + "'";
    const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                       H5Sclose, what);
    Handle dataset(
        H5Dcreate2(parent, name.c_str(), type, space.id(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        H5Dclose, what);
    if (H5Sget_simple_extent_npoints(space.id()) > 0) {
        check(H5Dwrite(dataset.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), what);
    }
    return dataset;
}

void write_numbers(hid_t parent, const std::string& name, std::span<const int> values) {
    const hsize_t count = values.size();
    write_array(parent, name, H5T_NATIVE_INT, {&count, 1}, values.data());
}

void write_numbers(hid_t parent, const std::string& name, std::span<const double> values) {
    const hsize_t count = values.size();
    write_array(parent, name, H5T_NATIVE_DOUBLE, {&count, 1}, values.data());
}

void write_number(hid_t parent, const std::string& name, double value) {
    write_numbers(parent, name, std::span<const double>(&value, 1));
}

Handle open_dataset(hid_t parent, const std::string& name) {
    return {H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose, "open dataset '" + name + "'"};
}

std::vector<hsize_t> shape_of(hid_t dataset) {
    const Handle space(H5Dget_space(dataset), H5Sclose, "read a dataset's shape");
    std::vector<hsize_t> shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space.id())));
    check(H5Sget_simple_extent_dims(space.id(), shape.data(), nullptr), "read a dataset's shape");
    return shape;
}

hsize_t rows_per_chunk(hid_t dataset) {
    const Handle creation(H5Dget_create_plist(dataset), H5Pclose, "read a dataset's layout");
    if (H5Pget_layout(creation.id()) != H5D_CHUNKED) return 1;
    std::vector<hsize_t> chunk(shape_of(dataset).size());
    check(H5Pget_chunk(creation.id(), static_cast<int>(chunk.size()), chunk.data()),
          "read a dataset's layout");
    return chunk.front();
}

bool is_kept_elsewhere(hid_t dataset, hid_t file) {
    const Handle creation(H5Dget_create_plist(dataset), H5Pclose, "read a dataset's layout");
    return H5Pget_layout(creation.id()) == H5D_VIRTUAL ||
           H5Pget_external_count(creation.id()) > 0 || name_of_file(dataset) != name_of_file(file);
}

void read_rows(hid_t dataset, hid_t memory_type, hsize_t begin, hsize_t count, void* values) {
    constexpr const char* kWhat = "read rows of a dataset";
    std::vector<hsize_t> size = shape_of(dataset);
    if (size.empty()) throw Error(std::string(kWhat) + ": it is a single value");
    std::vector<hsize_t> start(size.size(), 0);
    start.front() = begin;
    size.front() = count;
    const Handle space(H5Dget_space(dataset), H5Sclose, kWhat);
    check(H5Sselect_hyperslab(space.id(), H5S_SELECT_SET, start.data(), nullptr, size.data(),
                              nullptr),
          kWhat);
    const Handle memory(H5Screate_simple(static_cast<int>(size.size()), size.data(), nullptr),
                        H5Sclose, kWhat);
    check(H5Dread(dataset, memory_type, memory.id(), space.id(), H5P_DEFAULT, values), kWhat);
}

GrowingDataset::GrowingDataset(hid_t parent, const std::string& name, hid_t file_type,
                               std::vector<hsize_t> row_shape, hsize_t chunk_rows, unsigned deflate)
    : name_(name), row_shape_(std::move(row_shape)) {
    const std::string what = "create dataset '" + name + "'";
    std::vector<hsize_t> extent{0};
    std::vector<hsize_t> limit{H5S_UNLIMITED};
    std::vector<hsize_t> chunk{chunk_rows};
    for (auto* shape : {&extent, &limit, &chunk}) {
        shape->insert(shape->end(), row_shape_.begin(), row_shape_.end());
    }
    const int rank = static_cast<int>(extent.size());
    const Handle space(H5Screate_simple(rank, extent.data(), limit.data()), H5Sclose, what);
    const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
    check(H5Pset_chunk(creation.id(), rank, chunk.data()), what);
    if (deflate > 0) {
        check(H5Pset_shuffle(creation.id()), what);  // equal bytes side by side compress better
        check(H5Pset_deflate(creation.id(), deflate), what);
    }
    dataset_ = Handle(H5Dcreate2(parent, name.c_str(), file_type, space.id(), H5P_DEFAULT,
                                 creation.id(), H5P_DEFAULT),
                      H5Dclose, what);
    // HDF5 zeroes its buffer for converting rows at every write; the default one has a megabyte.
    constexpr std::size_t kConversionBytes = 1 << 16;
    transfer_ = Handle(H5Pcreate(H5P_DATASET_XFER), H5Pclose, what);
    check(H5Pset_buffer(transfer_.id(), kConversionBytes, nullptr, nullptr), what);
}

void GrowingDataset::append(hid_t memory_type, const void* rows, hsize_t count) {
    if (count == 0) return;
    const std::string what = "append to dataset '" + name_ + "'";
    std::vector<hsize_t> start{rows_};
    std::vector<hsize_t> block{count};
    std::vector<hsize_t> extent{rows_ + count};
    start.insert(start.end(), row_shape_.size(), 0);
    for (auto* shape : {&block, &extent}) {
        shape->insert(shape->end(), row_shape_.begin(), row_shape_.end());
    }
    check(H5Dset_extent(dataset_.id(), extent.data()), what);
    const Handle file_space(H5Dget_space(dataset_.id()), H5Sclose, what);
    check(H5Sselect_hyperslab(file_space.id(), H5S_SELECT_SET, start.data(), nullptr, block.data(),
                              nullptr),
          what);
    const Handle memory_space(
        H5Screate_simple(static_cast<int>(block.size()), block.data(), nullptr), H5Sclose, what);
    check(H5Dwrite(dataset_.id(), memory_type, memory_space.id(), file_space.id(), transfer_.id(),
                   rows),
          what);
    rows_ += count;
}

void GrowingDataset::flush() { check(H5Dflush(dataset_.id()), "flush dataset '" + name_ + "'"); }

void GrowingDataset::close() { dataset_.close("close dataset '" + name_ + "'"); }

}  // namespace weft::hdf5
