#include "apps/weft/output/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <iostream>

#include "apps/weft/output/duration_text.h"

namespace weft {

namespace {

constexpr int kBarWidth = 30;
constexpr std::chrono::milliseconds kBarInterval{50};
constexpr std::chrono::milliseconds kLineInterval{5000};
constexpr const char* kClearLine = "\r\033[K";

}  // namespace

Progress::Progress(std::string what, int total, bool quiet)
    : what_(std::move(what)), total_(total), quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
    if (drawn_) std::cerr << kClearLine << std::flush;
}

std::string Progress::time_left(int done, Clock::time_point now) const {
    if (done == 0) return "";
    const std::chrono::duration<double> elapsed = now - start_;
    return duration_text(elapsed.count() / done * (total_ - done)) + " left";
}

void Progress::show(int done, const std::string& note) {
    const Clock::time_point now = Clock::now();
    if (quiet_ || now - last_ < (terminal_ ? kBarInterval : kLineInterval)) return;
    last_ = now;
    const std::string text = time_left(done, now) + (note.empty() ? "" : ", ") + note;
    if (terminal_) {
        draw_bar(done, text);
        drawn_ = true;
    } else {
        std::cerr << fmt::format("weft: {} {} of {}, {}", what_, done, total_, text) << std::endl;
    }
}

void Progress::draw_bar(int done, const std::string& text) const {
    const int filled = static_cast<int>(static_cast<long>(kBarWidth) * done / total_);
    std::cerr << kClearLine
              << fmt::format("{} {}/{} [{:=<{}}{: <{}}] {}", what_, done, total_, "", filled, "",
                             kBarWidth - filled, text)
              << std::flush;
}

}  // namespace weft
