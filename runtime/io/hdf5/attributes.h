#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/io/hdf5/handle.h"

namespace weft::hdf5 {

void write_text_attribute(hid_t object, const std::string& name, const std::string& value);
void write_bool_attribute(hid_t object, const std::string& name, bool value);
void write_int_attribute(hid_t object, const std::string& name, std::span<const int> values);
void write_texts_attribute(hid_t object, const std::string& name,
                           const std::vector<std::string>& values);

std::string read_text_attribute(hid_t object, const std::string& name);
bool read_bool_attribute(hid_t object, const std::string& name);
int read_int_attribute(hid_t object, const std::string& name);
std::vector<std::string> attribute_names(hid_t object);

}  // namespace weft::hdf5
