#include "apps/weft/batch/deadline.h"

#include <algorithm>
#include <cstdlib>
#include <ctime>

namespace weft::batch {

namespace {

std::optional<double> seconds_that_slurm_leaves() {
    const char* text = std::getenv("SLURM_JOB_END_TIME");
    if (text == nullptr) return std::nullopt;
    char* rest = nullptr;
    const double end = std::strtod(text, &rest);
    if (rest == text || *rest != '\0') return std::nullopt;
    return std::max(0.0, end - static_cast<double>(std::time(nullptr)));
}

}  // namespace

Deadline::Deadline(std::optional<double> time_limit) {
    if (!time_limit) time_limit = seconds_that_slurm_leaves();
    if (!time_limit) return;
    const std::chrono::duration<double> span(*time_limit - stopping_margin(*time_limit));
    end_ = Clock::now() + std::chrono::duration_cast<Clock::duration>(span);
}

std::optional<double> Deadline::seconds_left() const {
    if (!end_) return std::nullopt;
    return std::chrono::duration<double>(*end_ - Clock::now()).count();
}

bool Deadline::is_over() const { return seconds_left().value_or(1.0) <= 0.0; }

double stopping_margin(double time_limit) {
    return std::min(std::clamp(0.05 * time_limit, 1.0, 60.0), 0.5 * time_limit);
}

}  // namespace weft::batch
