#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "runtime/trace/records.h"

namespace weft {

/// Turns frames of a trace into Chrome's trace-event JSON, which Perfetto's viewer
/// (https://ui.perfetto.dev) opens: a track per device, one of frames and their planning, copies
/// between memories, arrows where a device needs what another one made, and planned against
/// measured makespan as a counter.
///
/// Call head() once, frame() for each frame in order, tail() once; together they are the document.
class PerfettoText {
public:
    explicit PerfettoText(const RunDescription& run);

    std::string head();
    /// Throws UserError if the frame's records are damaged.
    std::string frame(const FrameRecord& frame);
    std::string tail() const;

private:
    /// Times are whole nanoseconds, so that neighbours which touch still do after rounding.
    struct Slice {
        std::int64_t start = 0, end = 0;
        int track = -1;  ///< -1: it is not there
    };
    struct Event {
        std::int64_t time = 0;
        std::int64_t order = 0;  ///< among those of one time
        std::string text;
    };
    /// What one frame adds.
    class Frame;

    void add(std::string& text, const nlohmann::ordered_json& event);
    void name_track(std::string& text, int track, const std::string& name);
    int copy_track(std::string& text, std::int64_t start, std::int64_t end);

    const RunDescription& run_;
    bool first_ = true;  ///< the next event has none before it
    std::uint64_t next_flow_ = 1;
    std::vector<std::int64_t> device_free_;  ///< [device] end of its last slice
    std::vector<std::int64_t> copies_free_;  ///< [track] likewise: copies may overlap
};

}  // namespace weft
