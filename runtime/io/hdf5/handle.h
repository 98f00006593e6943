#pragma once

#include <hdf5.h>

#include <mutex>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

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

}  // namespace weft::hdf5
