#include "runtime/io/hdf5/datasets.h"

#include "runtime/io/hdf5/types.h"

namespace weft::hdf5 {

namespace {

/// Of the file that an object is in.
std::string name_of_file(hid_t object) {
    const ssize_t length = H5Fget_name(object, nullptr, 0);
    if (length < 0) fail("read a file's name");
    std::string name(static_cast<std::size_t>(length), '\0');
    H5Fget_name(object, name.data(), name.size() + 1);
    return name;
}

}  // namespace

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

}  // namespace weft::hdf5
