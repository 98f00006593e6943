#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "simulation/checks/step_error.h"
#include "simulation/checks/unsolved_motion.h"
#include "simulation/checks/watch.h"

namespace weft {

/// In which frames it is estimated how far their steps were solved, and the data for it. Always the
/// last substep of a frame. Frames are chosen by counts, so that all estimates together take some
/// per cent of a per cent less than two of a run's time.
class ErrorSamples {
public:
    /// A run begins where the model is.
    ErrorSamples(const Model& model, int threads);

    /// It goes on from another state, where the model is, at a time [s].
    void restart(const Model& model, double time);
    /// It goes on where an earlier run of the same scene ended, and where the model is: what has
    /// moved has done so since the scene's start.
    void resume(const Model& model);

    /// Whether the frame's last substep is to be kept; frames of the scene that the model is of.
    bool wants(const Model& model, int frame) const;
    /// The model is at the start of that substep, at a time [s].
    void begin(const Model& model, double time);
    /// No substep of this frame is.
    void skip() { is_begun_ = false; }
    bool is_begun() const { return is_begun_; }
    /// The model is at its end; it was begun. contacts: as SubstepEnds has them. None: see
    /// StepError
    std::optional<StepEstimate> end(const Model& model, std::vector<FrozenContact> contacts);
    /// At a frame's end, where the model is. strain: of edges, RMS. Where they become plainly
    /// longer, frames are chosen for that, too
    void note(const Model& model, double strain);
    /// What the last estimate says against the state, where the model is: strain that is plain to
    /// see and that a solved step would not have left, as it is not the material that gives way
    /// then; or motion, or a place, that is of this kind.
    std::optional<Alarm> doubt(const Model& model, const Watch::Look& look,
                               const StepEstimate& estimate);
    /// A doubt was told, and the run goes on: what has sagged stays there, and is told once.
    void told() { is_told_ = true; }

    /// What the frame's estimate was made of; until note().
    const SubstepEnds& last() const { return *ends_; }
    /// The model has other steps from now on.
    void reset() { error_.reset(); }

private:
    std::optional<Alarm> doubt_of_strain(const Watch::Look& look,
                                         const StepEstimate& estimate) const;
    std::optional<Alarm> doubt_of_motion(const Model& model, double strain) const;
    std::optional<Alarm> doubt_of_led_solids(const Model& model, double relative_error) const;
    std::optional<Alarm> doubt_of_places(const Model& model);
    bool is_early(const Model& model) const;

    int threads_;
    double start_ = 0.0;  ///< [s]
    UnsolvedMotion motion_;
    bool is_told_ = false;
    int noted_ = 0;                     ///< frames
    int places_looked_at_ = 0;          ///< when: noted frames
    std::unique_ptr<StepError> error_;  ///< null: not needed yet
    bool is_begun_ = false;
    double first_strain_ = 0.0, last_strain_ = 0.0;  ///< of edges, RMS
    double most_strain_ = 0.0;                       ///< that an estimate was made at
    std::optional<SubstepEnds> ends_;
};

/// In scene order: whether an obstacle touches the vertex at a time [s]. Empty: there are none.
std::vector<char> held_by_obstacles(const Model& model, double time);

}  // namespace weft
