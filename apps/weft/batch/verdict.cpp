#include "apps/weft/batch/verdict.h"

#include <fmt/format.h>

#include <csignal>
#include <cstring>
#include <fstream>

#include "apps/weft/batch/drive.h"

namespace weft::batch {

namespace {

constexpr int kSignalled = 128;
constexpr std::uintmax_t kLongestEnd = 1 << 16;

std::uintmax_t size_of(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    return error ? 0 : size;
}

bool is_stopped(const ChildEnd& end) {
    if (end.signal != 0) return end.asked_to_stop || asks_to_stop(end.signal);
    return end.exit_code > kSignalled && asks_to_stop(end.exit_code - kSignalled);
}

std::string with_words(const std::string& what, const std::string& words) {
    return words.empty() ? what : what + "; its last words: " + words;
}

}  // namespace

LastWords::LastWords(std::filesystem::path log) : log_(std::move(log)), begin_(size_of(log_)) {}

std::string LastWords::text() const {
    const std::uintmax_t end = size_of(log_);
    std::ifstream file(log_, std::ios::binary);
    file.seekg(
        static_cast<std::streamoff>(end > begin_ + kLongestEnd ? end - kLongestEnd : begin_));
    constexpr std::string_view kError = "weft: error: ";
    std::string line, last, error;
    while (std::getline(file, line)) {
        if (line.starts_with(kError)) error = line.substr(kError.size());
        if (!line.empty()) last = line;
    }
    return error.empty() ? last : error;
}

Verdict verdict_of(const ChildEnd& end, const LastWords& words) {
    if (is_stopped(end)) return {State::kStopped, kGoesOn, "stopped"};
    if (end.signal != 0) {
        const std::string what =
            fmt::format("killed by signal {} ({}{})", end.signal, ::strsignal(end.signal),
                        end.signal == SIGKILL ? ": out of memory?" : "");
        return {State::kFailed, kFailed, with_words(what, words.text())};
    }
    if (end.exit_code == 0) return {};
    if (end.exit_code == kFailed || end.exit_code == kWrongRequest) {
        return {State::kFailed, end.exit_code, words.text()};
    }
    return {State::kFailed, kFailed,
            with_words(fmt::format("ended with exit code {}", end.exit_code), words.text())};
}

}  // namespace weft::batch
