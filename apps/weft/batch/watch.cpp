#include "apps/weft/batch/watch.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <set>
#include <thread>

#include "apps/weft/output/duration_text.h"

namespace weft::batch {

namespace {

constexpr std::chrono::milliseconds kPeriod{1000};
constexpr const char* kClearLine = "\r\033[K";

bool is_settled(const Listed& listed) {
    return listed.status.state == State::kFinished || listed.status.state == State::kFailed;
}

std::string progress_text(const std::string& name, const std::vector<Listed>& runs) {
    std::string text = name + ": " + counts_text(count_states(runs));
    if (const auto left = time_left(runs)) text += ", " + duration_text(*left) + " left";
    return text;
}

/// What failed since the last look.
std::string new_failures(const std::vector<Listed>& runs, std::set<std::size_t>& told) {
    std::string text;
    for (const auto& [run, status] : runs) {
        if (status.state != State::kFailed || !told.insert(run->index).second) continue;
        text += fmt::format("run {} ({}) failed: {}\n", run->index, values_text(*run), status.why);
    }
    return text;
}

}  // namespace

std::optional<double> time_left(const std::vector<Listed>& runs) {
    double seconds = 0.0;
    std::size_t finished = 0, running = 0, open = 0;
    for (const Listed& listed : runs) {
        finished += listed.status.state == State::kFinished;
        running += listed.status.state == State::kRunning;
        open += !is_settled(listed);
        if (listed.status.state == State::kFinished) seconds += listed.status.wall;
    }
    if (finished == 0 || running == 0) return std::nullopt;
    const double rounds = std::ceil(static_cast<double>(open) / static_cast<double>(running));
    return rounds * seconds / static_cast<double>(finished);
}

void watch(const std::filesystem::path& folder, const Manifest& manifest) {
    const bool terminal = ::isatty(STDERR_FILENO) == 1;
    std::set<std::size_t> told;
    std::string last;
    while (true) {
        const std::vector<Listed> runs = list_runs(folder, manifest, false);
        const std::string failures = new_failures(runs, told);
        const std::string text = progress_text(manifest.name, runs);
        if (terminal)
            std::cerr << kClearLine << failures << text << std::flush;
        else if (text != last)
            std::cerr << failures << text << std::endl;
        last = text;
        if (std::ranges::all_of(runs, is_settled)) break;
        std::this_thread::sleep_for(kPeriod);
    }
    if (terminal) std::cerr << std::endl;
}

}  // namespace weft::batch
