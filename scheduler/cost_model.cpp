#include "scheduler/cost_model.h"

#include <algorithm>
#include <cmath>

namespace weft::scheduler {
namespace {

// Median deviation to standard deviation of a normal distribution.
constexpr double kDeviationScale = 1.4826;
// Item counts that differ by less (relative standard deviation) do not tell the fixed part of a
// cost from the part per item.
constexpr double kLeastSpreadOfItems = 0.05;

double median_of(std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    if (values.size() % 2 == 1) return *middle;
    return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

/// Weighted least squares of seconds = fixed + per_item * items, with both parts >= 0.
class LineFit {
public:
    void add(double items, double seconds, double weight) {
        sum_ += weight;
        x_ += weight * items;
        y_ += weight * seconds;
        xx_ += weight * items * items;
        xy_ += weight * items * seconds;
    }
    /// Whether the item counts differ enough to tell the two parts apart.
    bool tells_parts() const {
        const double mean = x_ / sum_;
        const double variance = xx_ / sum_ - mean * mean;
        return variance > kLeastSpreadOfItems * kLeastSpreadOfItems * mean * mean;
    }
    LinearCost solve() const {
        const double slope = (sum_ * xy_ - x_ * y_) / (sum_ * xx_ - x_ * x_);
        const double fixed = (y_ - slope * x_) / sum_;
        if (slope < 0.0) return {y_ / sum_, 0.0};
        if (fixed < 0.0) return {0.0, xy_ / xx_};
        return {fixed, slope};
    }
    /// All of the cost per item, or fixed where there are no items.
    LinearCost proportional() const {
        return xx_ > 0.0 ? LinearCost{0.0, xy_ / xx_} : LinearCost{y_ / sum_, 0.0};
    }

private:
    double sum_ = 0.0, x_ = 0.0, y_ = 0.0, xx_ = 0.0, xy_ = 0.0;
};

}  // namespace

CostModel::CostModel(std::uint32_t kinds, std::uint32_t devices, const CostModelSettings& settings)
    : kinds_(kinds), devices_(devices), settings_(settings) {
    settings_.window = std::max(settings_.window, 1u);
    const std::size_t entries = std::size_t{kinds} * devices;
    entries_.resize(entries);
    samples_.resize(entries * kSamples);
    points_.resize(entries * 2 * settings_.window);
    const std::size_t most = std::max<std::size_t>(kSamples, 2 * std::size_t{settings_.window});
    window_.reserve(most);
    ratio_.reserve(most);
    sorted_.reserve(most);
    believed_.reserve(most);
}

void CostModel::observe(std::uint32_t kind, std::uint32_t device, double items, double seconds) {
    if (!(seconds >= 0.0) || !std::isfinite(seconds)) return;
    const std::size_t e = index(kind, device);
    Entry& entry = entries_[e];
    if (entry.executions++ < settings_.discard_first) {
        believe_first(entry, items, seconds);
        return;
    }
    samples_[e * kSamples + entry.pending++ % kSamples] = {items, seconds};
}

double CostModel::last_items(std::uint32_t kind, std::uint32_t device) const {
    const std::uint32_t capacity = 2 * settings_.window;
    const std::size_t e = index(kind, device);
    const Entry& known = entries_[e];
    if (known.points == 0) return 0.0;
    return points_[e * capacity + (known.oldest + known.points - 1) % capacity].items;
}

// A first execution is too long, but better than no idea at all: it holds until there is another.
void CostModel::believe_first(Entry& entry, double items, double seconds) const {
    entry.last_frame = frame_;
    if (entry.fit.frames > 0 && !(entry.guessed && seconds < entry.fit.cost(items))) return;
    entry.fit.cost = items > 0.0 ? LinearCost{0.0, seconds / items} : LinearCost{seconds, 0.0};
    entry.fit.frames = 1;
    entry.guessed = true;
}

void CostModel::restore(std::uint32_t kind, std::uint32_t device, const CostFit& fit) {
    entries_[index(kind, device)].fit = fit;
    entries_[index(kind, device)].guessed = false;
}

void CostModel::refit() {
    for (std::size_t e = 0; e < entries_.size(); ++e) {
        if (entries_[e].pending == 0) continue;
        add_frame(e);
        fit_points(e);
    }
    ++frame_;
}

// Marks the samples whose ratio to the reference lies near the median ratio.
void CostModel::judge(std::span<const Sample> samples, const LinearCost& reference) {
    ratio_.clear();
    for (const Sample& s : samples) {
        const double expected = reference(s.items);
        ratio_.push_back(expected > 0.0 ? s.seconds / expected : s.seconds);
    }
    sorted_ = ratio_;
    median_ = median_of(sorted_);
    sorted_.clear();
    for (const double r : ratio_) sorted_.push_back(std::abs(r - median_));
    deviation_ = kDeviationScale * median_of(sorted_);
    const double allowed =
        std::max(settings_.outlier_limit * deviation_, settings_.outlier_floor * median_);
    believed_.clear();
    for (const double r : ratio_) believed_.push_back(std::abs(r - median_) <= allowed);
}

// What times are compared with to find outliers: the present fit, or a line through them all.
LinearCost CostModel::reference_for(const Entry& entry, std::span<const Sample> samples) const {
    if (entry.fit.frames > 0 && entry.fit.cost(samples.front().items) > 0.0) return entry.fit.cost;
    LineFit line;
    for (const Sample& s : samples) line.add(s.items, s.seconds, 1.0);
    return line.tells_parts() ? line.solve() : line.proportional();
}

// Condenses the frame's samples to the means of those with few and of those with many items: both
// lie on the line if the samples do. The halves are judged apart, since a fit whose proportion of
// fixed cost is still wrong would take the rarer item counts for outliers.
void CostModel::add_frame(std::size_t e) {
    Entry& entry = entries_[e];
    Sample* first = samples_.data() + e * kSamples;
    Sample* last = first + std::min(entry.pending, kSamples);
    const auto [few, many] = std::minmax_element(
        first, last, [](const Sample& a, const Sample& b) { return a.items < b.items; });
    const double middle = 0.5 * (few->items + many->items);
    Sample* half = std::partition(first, last, [&](const Sample& s) { return s.items <= middle; });
    add_believed(e, {first, half});
    add_believed(e, {half, last});
    entry.pending = 0;
    entry.last_frame = frame_;
}

void CostModel::add_believed(std::size_t e, std::span<const Sample> samples) {
    if (samples.empty()) return;
    judge(samples, reference_for(entries_[e], samples));
    double count = 0.0, items = 0.0, seconds = 0.0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (!believed_[i]) continue;
        count += 1.0;
        items += samples[i].items;
        seconds += samples[i].seconds;
    }
    add_point(e, items / count, seconds / count);
}

void CostModel::add_point(std::size_t e, double items, double seconds) {
    Entry& entry = entries_[e];
    const std::uint32_t capacity = 2 * settings_.window;
    Point* ring = points_.data() + e * capacity;
    ring[(entry.oldest + entry.points) % capacity] = {items, seconds, frame_};
    if (entry.points < capacity) {
        ++entry.points;
    } else {
        entry.oldest = (entry.oldest + 1) % capacity;
    }
    forget_old_points(entry, e);
}

void CostModel::forget_old_points(Entry& entry, std::size_t e) const {
    const std::uint32_t capacity = 2 * settings_.window;
    const Point* ring = points_.data() + e * capacity;
    const auto newest = ring[(entry.oldest + entry.points - 1) % capacity].frame;
    while (newest - ring[entry.oldest].frame > settings_.forget_after) {
        entry.oldest = (entry.oldest + 1) % capacity;
        --entry.points;
    }
}

// Least squares of relative errors over the believed points of the window.
void CostModel::fit_points(std::size_t e) {
    Entry& entry = entries_[e];
    const std::uint32_t capacity = 2 * settings_.window;
    const Point* ring = points_.data() + e * capacity;
    // A frame gives one or two points, so the ring may hold more frames than the window.
    const std::uint32_t newest = ring[(entry.oldest + entry.points - 1) % capacity].frame;
    std::uint32_t frames = 0;
    window_.clear();
    std::uint32_t last = newest + 1;
    for (std::uint32_t i = entry.points; i-- > 0;) {
        const Point& point = ring[(entry.oldest + i) % capacity];
        if (point.frame != last && ++frames > settings_.window) break;
        last = point.frame;
        window_.push_back({point.items, point.seconds});
    }
    const LinearCost reference = reference_for(entry, window_);
    judge(window_, reference);

    LineFit line;
    double ratio = 0.0;
    int believed = 0;
    for (std::size_t i = 0; i < window_.size(); ++i) {
        if (!believed_[i]) continue;
        const double expected = reference(window_[i].items);
        const double weight = expected > 0.0 ? 1.0 / (expected * expected) : 1.0;
        line.add(window_[i].items, window_[i].seconds, weight);
        ratio += ratio_[i];
        ++believed;
    }
    if (line.tells_parts()) {
        entry.fit.cost = line.solve();
    } else if (reference(window_.front().items) > 0.0) {
        // Too alike to tell the parts: keep their proportion, correct the level.
        const double level = ratio / believed;
        entry.fit.cost = {reference.fixed * level, reference.per_item * level};
    } else {
        entry.fit.cost = line.proportional();
    }
    entry.fit.spread = median_ > 0.0 ? deviation_ / median_ : 0.0;
    entry.fit.frames += entry.guessed ? 0 : 1;  // the guess has counted as one
    entry.guessed = false;
}

}  // namespace weft::scheduler
