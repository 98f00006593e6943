#include "runtime/io/hdf5/attributes.h"

#include "runtime/io/hdf5/types.h"

namespace weft::hdf5 {

namespace {

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

}  // namespace

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

}  // namespace weft::hdf5
