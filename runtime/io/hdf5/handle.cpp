#include "runtime/io/hdf5/handle.h"

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

}  // namespace weft::hdf5
