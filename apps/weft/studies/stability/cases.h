#pragma once

#include <string>
#include <vector>

#include "simulation/scene/method.h"

namespace weft::stability {

/// How a run comes out.
enum class Verdict {
    kStable,       ///< as the criterion says
    kDissipated,   ///< right in shape, but most of its motion is lost
    kUnconverged,  ///< finite, but not what the scene says: stretched, passed through, not
                   ///< recovered
    kExploded,     ///< energy from nowhere
    kStopped,      ///< refused, or not finite
};
inline constexpr Verdict kVerdicts[] = {Verdict::kStable, Verdict::kDissipated,
                                        Verdict::kUnconverged, Verdict::kExploded,
                                        Verdict::kStopped};
const char* name_of(Verdict verdict);

/// What is measured at the end of a case's run.
enum class Quantity {
    kStrain,     ///< of edges, RMS
    kWorst,      ///< of the worst edge
    kFall,       ///< of the centre of mass, in parts of a free fall
    kRise,       ///< of the centre of mass [m]
    kDrift,      ///< of the centre of mass sideways, in parts of the size at rest
    kSize,       ///< diagonal of the box around it, in parts of that at rest
    kLost,       ///< dissipated, in parts of what there was to be had
    kCrossings,  ///< pairs of triangles that go through each other
};

/// One line of a criterion.
struct Bound {
    Quantity quantity;
    double low, high;
    Verdict otherwise = Verdict::kUnconverged;
};

/// How a run starts, if not as its scene says.
enum class Start {
    kAsWritten,
    kOnSphere,   ///< every vertex at random
    kInPlane,    ///< likewise
    kOnLine,     ///< likewise
    kInPoint,    ///< all in one place
    kInverted,   ///< mirrored
    kStretched,  ///< 100 times as long along x
    kThrown,     ///< down, at 1000 m/s
};

/// A scene that is generated, and what must be seen at its end.
struct Case {
    std::string group;  ///< a map, or a list of single cases
    std::string name;
    std::string scene;  ///< TOML without [solver]
    int iterations = 8;
    Start start = Start::kAsWritten;
    std::vector<Bound> criterion;
    /// Where it is on its group's map; without units, or [ms].
    double across = 0.0, up = 0.0;
    bool in_short = false;  ///< in the short form, too
};

/// A plane on which cases lie.
struct Map {
    std::string group;
    std::string title, across, up;
};

/// The shipped suite. Every case is run by every solver.
std::vector<Case> all_cases();
std::vector<Map> all_maps();
std::string text_of(const std::vector<Bound>& criterion);

}  // namespace weft::stability
