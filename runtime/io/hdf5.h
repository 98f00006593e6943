#pragma once

#include <hdf5.h>

#include <cstddef>
#include <mutex>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The little of HDF5 that Weft's files need, over the C API: handles that close themselves, and
/// errors as exceptions. Callers add the file's path and the exception type their users know.

namespace weft::hdf5 {

/// An HDF5 call failed. what() = "<what was tried>: <the system's or the library's reason>".
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Held around every use of the library; handles hold one while they close. HDF5 may be built
/// without threads, and its error messages are switched per thread: both are settled here.
class Session {
public:
    Session();
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

private:
    std::unique_lock<std::recursive_mutex> lock_;
    H5E_auto2_t printer_ = nullptr;
    void* printer_data_ = nullptr;
};

/// Throws Error with `what` and the innermost reason on the library's error stack.
[[noreturn]] void fail(std::string_view what);

/// For calls that answer with a negative number on failure.
inline void check(herr_t status, std::string_view what) {
    if (status < 0) fail(what);
}

/// An object of the library, closed with its owner.
class Handle {
public:
    using Closer = herr_t (*)(hid_t);

    Handle() = default;
    Handle(hid_t id, Closer closer, std::string_view what) : id_(id), closer_(closer) {
        if (id < 0) fail(what);
    }
    Handle(Handle&& other) noexcept
        : id_(std::exchange(other.id_, H5I_INVALID_HID)), closer_(other.closer_) {}
    Handle& operator=(Handle&& other) noexcept;
    ~Handle() { reset(); }

    /// Closes now; errors are dropped, use close() where they count.
    void reset() noexcept;
    /// Closes now; throws Error if the library cannot, e.g. because the disk is full.
    void close(std::string_view what);
    /// Never closes it. For a file that could not be written, and all that is open in it: closing
    /// would write on, and make a file unreadable of which all earlier flushes are intact.
    void abandon() { id_ = H5I_INVALID_HID; }

    hid_t id() const { return id_; }
    explicit operator bool() const { return id_ >= 0; }

private:
    hid_t id_ = H5I_INVALID_HID;
    Closer closer_ = nullptr;
};

// Files ------------------------------------------------------------------------------------------

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

// Types and attributes ---------------------------------------------------------------------------

Handle string_type();  ///< UTF-8, variable length: h5py gives str for it
Handle bool_type();    ///< the enum that h5py reads and writes as bool

void write_text_attribute(hid_t object, const std::string& name, const std::string& value);
void write_bool_attribute(hid_t object, const std::string& name, bool value);
void write_int_attribute(hid_t object, const std::string& name, std::span<const int> values);

void write_texts_attribute(hid_t object, const std::string& name,
                           const std::vector<std::string>& values);

std::string read_text_attribute(hid_t object, const std::string& name);
bool read_bool_attribute(hid_t object, const std::string& name);
int read_int_attribute(hid_t object, const std::string& name);
std::vector<std::string> attribute_names(hid_t object);

// Datasets ---------------------------------------------------------------------------------------

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

/// A dataset that grows along its first dimension.
class GrowingDataset {
public:
    GrowingDataset() = default;
    /// row_shape    extents of the other dimensions; empty for a table
    /// chunk_rows   rows compressed and read together
    /// deflate      0 = stored as is, so that rewriting a half-filled chunk takes no new space
    GrowingDataset(hid_t parent, const std::string& name, hid_t file_type,
                   std::vector<hsize_t> row_shape, hsize_t chunk_rows, unsigned deflate);

    /// Adds `count` rows of `memory_type` at the end.
    void append(hid_t memory_type, const void* rows, hsize_t count);
    /// Hands everything to the operating system: from here on it survives the process.
    void flush();
    void close();
    void abandon() { dataset_.abandon(); }

    const std::string& name() const { return name_; }
    hid_t id() const { return dataset_.id(); }
    hsize_t rows() const { return rows_; }

private:
    std::string name_;
    Handle dataset_;
    Handle transfer_;
    std::vector<hsize_t> row_shape_;
    hsize_t rows_ = 0;
};

}  // namespace weft::hdf5
