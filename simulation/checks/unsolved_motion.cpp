#include "simulation/checks/unsolved_motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulation/model/model.h"

namespace weft {

namespace {

// Measured on 80 scenes by five solvers, compared with runs of a quarter of the step. Where bodies
// only sagged, solved steps took back 0.2 to 0.8 of the way; where they moved much as they should,
// 0.04 at most.
constexpr double kPart = 0.15;
constexpr double kVisible = 5e-4;  ///< of a body's size
// Where strain made the motion, moved^2 / (e L^2) was 0.02 to 0.3, with two thirds of the strain
// undone; elsewhere 1 and more.
constexpr double kHanging = 0.375;
constexpr double kReturned = 0.25;  ///< of the farthest way: what has come back says nothing
constexpr double kVisibleStrain = 1e-3;
constexpr double kPartOfStrain = 0.5;
// Measured on 55 scenes by four solvers, compared with steps that are solved: see
// docs/measurements.md.
constexpr double kPush = 0.15;            ///< of gravity
constexpr double kMisplaced = 0.15;       ///< of the way of a body's middle
constexpr double kPlainlyVisible = 1e-3;  ///< likewise of a body's size
constexpr double kMoving = 0.75;          ///< of the way that its middle has come lately
constexpr std::size_t kLately = 256;      ///< frames, at most

constexpr double kUlp = std::numeric_limits<float>::epsilon();
constexpr double kRounded = 2.0 * kUlp;  ///< what rounding makes of a mean: of coordinates

/// Coordinate from 0.
double farthest(std::span<const float> xyz) {
    double most = 0.0;
    for (const float x : xyz) most = std::max(most, std::abs(static_cast<double>(x)));
    return most;
}

/// Keeps the one of which the most is undone.
void keep_worse(std::optional<UnsolvedMotion::Found>& worst, UnsolvedMotion::Found found) {
    if (!worst || found.undone * worst->moved > worst->undone * found.moved) worst = found;
}

}  // namespace

UnsolvedMotion::UnsolvedMotion(const Model& model)
    : starts_(model), most_bodies_(starts_.count()), most_middles_(starts_.count()) {}

UnsolvedMotion::Moved UnsolvedMotion::moved(const Model& model) const {
    Moved now;
    double mass = 0.0;
    double sum = 0.0;
    for (std::size_t b = 0; b < starts_.count(); ++b) {
        const double way = starts_.rms_way(model, b);
        now.bodies.push_back(way);
        now.middles.push_back(starts_.mean_way(model, b));
        mass += starts_.mass(b);
        sum += starts_.mass(b) * way * way;
    }
    if (mass > 0.0) now.all = std::sqrt(sum / mass);
    return now;
}

void UnsolvedMotion::note(const Model& model) {
    const Moved now = moved(model);
    most_all_ = std::max(most_all_, now.all);
    for (std::size_t b = 0; b < starts_.count(); ++b) {
        most_bodies_[b] = std::max(most_bodies_[b], now.bodies[b]);
        most_middles_[b] = std::max(most_middles_[b], length(now.middles[b]));
    }
    lately_.push_front(now.middles);
    if (lately_.size() > kLately) lately_.pop_back();
}

void UnsolvedMotion::resume(const Model& model) {
    lately_.clear();
    note(model);
}

std::optional<UnsolvedMotion::Found> UnsolvedMotion::find(const Model& model,
                                                          std::span<const float> solved) const {
    const Moved now = moved(model);
    std::optional<Found> worst;
    for (std::size_t b = 0; b < starts_.count(); ++b) {
        const double way = std::max(most_bodies_[b], now.bodies[b]);
        const double undone = starts_.rms_way(model, b, solved);
        if (undone <= kPart * way || undone <= kVisible * starts_.size(b)) continue;
        keep_worse(worst, {b, way, undone});
    }
    return worst;
}

std::optional<double> UnsolvedMotion::find(const Model& model, double strain, double solved) const {
    const double undone = std::sqrt(std::max(strain * strain - solved * solved, 0.0));
    if (undone < kVisibleStrain || undone < kPartOfStrain * strain) return std::nullopt;
    const double now = moved(model).all;
    const double way = std::max(now, kReturned * most_all_);
    if (way * way >= kHanging * undone * size() * size()) return std::nullopt;
    return now;
}

std::optional<UnsolvedMotion::Ways> UnsolvedMotion::pushed(const Model& model,
                                                           std::span<const float> solved,
                                                           std::span<const char> borne,
                                                           double fallen) const {
    const double least = std::max(kPush * fallen, kRounded * farthest(solved));
    const Moved now = moved(model);
    std::optional<Ways> ways;
    for (std::size_t b = 0; b < starts_.count(); ++b) {
        if (borne[b] == 0 || length(starts_.mean_way(model, b, solved)) <= least) continue;
        const double way = std::max(most_middles_[b], length(now.middles[b]));
        if (!ways) ways = {way, way};
        ways = {std::min(ways->least, way), std::max(ways->most, way)};
    }
    return ways;
}

double UnsolvedMotion::hidden(double way) { return kMisplaced * way; }

/// The farthest that the body's middle was from where it is [m], so many frames ago and since; all
/// of its way, where not so many are known.
double UnsolvedMotion::moved_lately(std::size_t body, Vec3 middle, double frames) const {
    const std::size_t window = std::min(static_cast<std::size_t>(std::ceil(frames)), kLately);
    if (lately_.size() < window) return length(middle);
    double most = 0.0;
    for (std::size_t k = 0; k < window; ++k) {
        most = std::max(most, length(middle - lately_[k][body]));
    }
    return most;
}

std::optional<UnsolvedMotion::Found> UnsolvedMotion::find_misplaced(const Model& model,
                                                                    std::span<const float> settled,
                                                                    std::span<const char> borne,
                                                                    double gravity) const {
    const Moved now = moved(model);
    // Contacts give way by a part of it, and what lies on several of them by more.
    const double give = model.scene.contact ? model.scene.contact->thickness : 0.0;
    // What pins twist and pull buckles, and is about to snap somewhere.
    const double part = model.moving_pins ? 2.0 * kMisplaced : kMisplaced;
    std::optional<Found> worst;
    for (std::size_t b = 0; b < starts_.count(); ++b) {
        if (borne[b] == 0) continue;
        const double way = std::max(most_middles_[b], length(now.middles[b]));
        const double off = length(starts_.mean_way(model, b, settled));
        const double visible = std::max(give, kPlainlyVisible * starts_.size(b));
        if (off <= part * way || off <= visible) continue;
        const double frames = std::sqrt(way / gravity) / model.scene.dt;
        if (off <= kMoving * moved_lately(b, now.middles[b], frames)) continue;
        keep_worse(worst, {b, way, off});
    }
    return worst;
}

}  // namespace weft
