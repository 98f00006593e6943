#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace weft::scheduler {

/// Predicted time of one execution: fixed + per_item * items [s]; both parts >= 0.
struct LinearCost {
    double fixed = 0.0;
    double per_item = 0.0;

    double operator()(double items) const { return fixed + per_item * items; }
};

/// What is known of one kind of task on one device, as plain numbers to save and load.
struct CostFit {
    LinearCost cost;
    double spread = 0.0;       ///< typical relative deviation of a frame from the fit
    std::uint32_t frames = 0;  ///< frames that were learnt from; 0: nothing is known yet
};

struct CostModelSettings {
    /// First executions of a kind on a device that are not believed: they compile, load and page
    /// in.
    std::uint32_t discard_first = 2;
    /// A fit stands on the last `window` observed frames. What disturbs less than half of them is
    /// rejected; what lasts longer is followed, and forgotten as soon after it has ended.
    std::uint32_t window = 12;
    /// Frames after which an observation is dropped once there are newer ones. A device that was
    /// out of use for so long is judged by its probe alone, and not by what drove it out.
    std::uint32_t forget_after = 24;
    /// An observation is an outlier if it deviates from the median by more than this many median
    /// deviations (scaled to standard deviations of a normal distribution) ...
    double outlier_limit = 3.0;
    /// ... and by more than this part of the median.
    double outlier_floor = 0.05;
};

/// Learns online what each kind of task costs on each device, from measured executions.
///
/// Call observe() for every execution, refit() once per frame, predict() for the next plan.
/// Transfers, launches and waits can be kinds as well; their items are bytes, or always 1.
/// Not thread-safe.
class CostModel {
public:
    CostModel(std::uint32_t kinds, std::uint32_t devices, const CostModelSettings& settings = {});

    std::uint32_t kinds() const { return kinds_; }
    std::uint32_t devices() const { return devices_; }

    /// Notes one execution (cheap: a store). Times that are negative or not finite are ignored.
    void observe(std::uint32_t kind, std::uint32_t device, double items, double seconds);

    /// Ends a frame: learns from what was observed since the last call.
    void refit();

    /// Predicted seconds; 0 while nothing is known, so that an unknown device will be tried.
    double predict(std::uint32_t kind, std::uint32_t device, double items) const {
        return entry(kind, device).fit.cost(items);
    }
    /// Whether predict() rests on anything: an observation, or a restored fit.
    bool known(std::uint32_t kind, std::uint32_t device) const {
        return entry(kind, device).fit.frames > 0;
    }
    /// Frames since the kind was last observed on the device; since the start if it never was.
    std::uint32_t frames_unobserved(std::uint32_t kind, std::uint32_t device) const {
        return frame_ - entry(kind, device).last_frame;
    }

    /// Of how many items the last observation tells; 0 where there was none that is believed.
    double last_items(std::uint32_t kind, std::uint32_t device) const;

    const CostFit& fit(std::uint32_t kind, std::uint32_t device) const {
        return entry(kind, device).fit;
    }
    /// Starts from a fit that was saved earlier: it holds until there are new observations, which
    /// overrule its level at once and its shape as soon as their item counts differ enough.
    void restore(std::uint32_t kind, std::uint32_t device, const CostFit& fit);

private:
    struct Sample {
        double items, seconds;
    };
    /// Mean of the believed samples of one frame with few, or with many items.
    struct Point {
        double items, seconds;
        std::uint32_t frame;
    };
    struct Entry {
        CostFit fit;
        bool guessed = false;          // the fit comes from discarded executions only
        std::uint32_t executions = 0;  // all that were observed
        std::uint32_t pending = 0;     // of them since the last refit
        std::uint32_t last_frame = 0;
        std::uint32_t points = 0, oldest = 0;  // ring in points_
    };
    static constexpr std::uint32_t kSamples = 64;  // per entry and frame; the last ones are kept

    std::size_t index(std::uint32_t kind, std::uint32_t device) const {
        return std::size_t{kind} * devices_ + device;
    }
    const Entry& entry(std::uint32_t kind, std::uint32_t device) const {
        return entries_[index(kind, device)];
    }
    void believe_first(Entry& entry, double items, double seconds) const;
    void add_frame(std::size_t e);
    void add_believed(std::size_t e, std::span<const Sample> samples);
    void add_point(std::size_t e, double items, double seconds);
    void forget_old_points(Entry& entry, std::size_t e) const;
    void fit_points(std::size_t e);
    LinearCost reference_for(const Entry& entry, std::span<const Sample> samples) const;
    void judge(std::span<const Sample> samples, const LinearCost& reference);

    std::uint32_t kinds_, devices_;
    CostModelSettings settings_;
    std::uint32_t frame_ = 0;
    std::vector<Entry> entries_;   // [kind][device]
    std::vector<Sample> samples_;  // [kind][device][kSamples]
    std::vector<Point> points_;    // [kind][device][2 * window]
    // Working memory of one fit.
    std::vector<Sample> window_;
    std::vector<double> ratio_, sorted_;
    std::vector<bool> believed_;
    double median_ = 0.0, deviation_ = 0.0;
};

}  // namespace weft::scheduler
