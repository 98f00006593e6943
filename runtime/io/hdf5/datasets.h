#pragma once

#include <span>
#include <string>
#include <vector>

#include "runtime/io/hdf5/handle.h"

namespace weft::hdf5 {

void write_text(hid_t parent, const std::string& name, const std::string& value);
void write_texts(hid_t parent, const std::string& name, const std::vector<std::string>& values);
std::string read_text(hid_t parent, const std::string& name);
std::vector<std::string> read_texts(hid_t parent, const std::string& name);

/// Fixed-size dataset of any rank.
Handle write_array(hid_t parent, const std::string& name, hid_t type,
                   std::span<const hsize_t> shape, const void* values);

/// Along one dimension.
void write_numbers(hid_t parent, const std::string& name, std::span<const int> values);
void write_numbers(hid_t parent, const std::string& name, std::span<const double> values);
/// One, as a list of it.
void write_number(hid_t parent, const std::string& name, double value);

Handle open_dataset(hid_t parent, const std::string& name);
/// Empty for a single value.
std::vector<hsize_t> shape_of(hid_t dataset);
/// How many rows (of its first dimension) are stored, and unpacked, together.
hsize_t rows_per_chunk(hid_t dataset);
/// Whether its values, or some of them, are kept in another file than `file`, or may be.
bool is_kept_elsewhere(hid_t dataset, hid_t file);
/// `count` rows from row `begin` on, as `memory_type`.
void read_rows(hid_t dataset, hid_t memory_type, hsize_t begin, hsize_t count, void* values);

}  // namespace weft::hdf5
