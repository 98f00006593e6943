#pragma once

#include <optional>
#include <string>

#include "runtime/planning/frame_plan.h"
#include "runtime/planning/timing_model.h"
#include "simulation/scene/scene.h"
#include "simulation/solver/async_settings.h"
#include "simulation/solver/solver.h"

namespace weft {

/// Whether an asynchronous plan would be faster than the best of the others, to the error that
/// these reach with the scene's iterations. Found out step by step, the cheapest first: most
/// machines hide their waits so well that there is nothing to gain.
class AsyncOffer {
public:
    /// What there is to compare with and what it is known by.
    struct Question {
        Model& model;
        Solver& solver;         ///< of the model's scene
        const FramePlan& plan;  ///< the best without asynchrony
        const TimingModel& timing;
        Division division;  ///< that an asynchronous plan would have, of all devices
        const AsyncSettings& settings;
    };
    explicit AsyncOffer(const Question& question);

    bool is_better() const { return is_better_; }
    /// One line: yes or no, and the times that say so.
    const std::string& why() const { return why_; }

private:
    void compare_times(const Question& question);
    void compare_errors(const Question& question);

    double others_ = 0.0;  ///< what the best of them takes for a substep [s]
    double time_ = 0.0;    ///< what an asynchronous plan does
    bool is_better_ = false;
    std::string why_;
};

}  // namespace weft
