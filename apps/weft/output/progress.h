#pragma once

#include <chrono>
#include <string>

namespace weft {

/// How far a run is, on stderr: a bar with the time left on a terminal, a line every few seconds
/// otherwise. Silent if told so. It takes its bar away when it goes.
class Progress {
public:
    Progress(std::string what, int total, bool quiet);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// So many of `total` are done. note: what else there is to say
    void show(int done, const std::string& note = "");

private:
    using Clock = std::chrono::steady_clock;

    void draw_bar(int done, const std::string& text) const;
    std::string time_left(int done, Clock::time_point now) const;

    std::string what_;
    int total_;
    bool quiet_;
    bool terminal_;
    bool drawn_ = false;
    Clock::time_point start_ = Clock::now();
    Clock::time_point last_ = start_;
};

}  // namespace weft
