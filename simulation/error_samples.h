#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "simulation/step_error.h"

namespace weft {

/// In which frames it is estimated how far their steps were solved, and the data for it. Always the
/// last substep of a frame. Frames are chosen by counts, so that all estimates together take some
/// per cent of a per cent less than two of a run's time.
class ErrorSamples {
public:
    explicit ErrorSamples(int threads) : threads_(threads) {}

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
    // Of edges, RMS. Where they become plainly longer, frames are chosen for that, too.
    /// Before anything has happened: nobody has to answer for that.
    void expect_strain(double strain) { first_strain_ = last_strain_ = most_strain_ = strain; }
    /// At a frame's end.
    void note_strain(double strain) { last_strain_ = strain; }
    /// Whether strain is plain to see that a solved step would not have left: then it is not the
    /// material that gives way. energy: of all strain [J]
    bool doubts(double strain, double energy, const StepEstimate& estimate) const;

    /// What the last estimate was made of.
    const SubstepEnds& last() const { return *ends_; }
    /// The model has other steps from now on.
    void reset() { error_.reset(); }

private:
    int threads_;
    std::unique_ptr<StepError> error_;  ///< null: not needed yet
    bool is_begun_ = false;
    double first_strain_ = 0.0, last_strain_ = 0.0;
    double most_strain_ = 0.0;  ///< that an estimate was made at
    std::optional<SubstepEnds> ends_;
};

/// In scene order: whether an obstacle touches the vertex at a time [s]. Empty: there are none.
std::vector<char> held_by_obstacles(const Model& model, double time);

/// An estimate is made in the last one of so many frames.
int frames_per_estimate(const Model& model);

}  // namespace weft
