#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "runtime/io/hdf5/handle.h"

namespace weft::hdf5 {

enum class FileFormat {
    kSwmr,   ///< HDF5 1.10: one writer and many readers at once. A killed writer leaves it marked.
    kPlain,  ///< HDF5 1.8 superblock: opens plainly at any time, whoever is writing it.
};

/// Creates the file, under the name <path>.part until publish(): nobody finds a half-made one.
/// chunks  up to so many chunks of a dataset (kPlain) are listed in one node of its index
Handle create_file(const std::string& path, FileFormat format, std::size_t chunks = 64);
/// Gives a created file its name, once it is fit to be read. Readers of an old file of that name
/// keep theirs.
void publish(const std::string& path);
/// Opens to read; also a file that is being written, or whose writer was killed (SWMR).
Handle open_to_read(const std::string& path);
/// Opens to read, and refuses a file that was cut off, or that someone has not written to its end:
/// the library would give zeros for what is missing.
Handle open_whole(const std::string& path);
Handle open_to_modify(const std::string& path);

Handle create_group(hid_t parent, const std::string& name);
/// A link to the root of another file; a relative path counts from the folder of this one.
void link_external(hid_t parent, const std::string& name, const std::string& path);
bool exists(hid_t parent, const std::string& name);
/// "/group/name" of all datasets of a file, but those that are only linked from another one.
std::vector<std::string> dataset_paths(hid_t file);

}  // namespace weft::hdf5
