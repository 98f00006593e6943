#pragma once

#include "simulation/solver/moment_sums.h"

namespace weft {

/// Where the mass of free bodies is and where it should be, body by body: what several tasks read
/// that see bodies as wholes.
class BodyMoments {
public:
    /// bodies must outlive this. first_run, counts: [bodies] of each one's runs
    BodyMoments(FreeBodies& bodies, Buffer<int>& first_run, Buffer<float>& counts);

    /// First they are added up by runs,
    MomentSums& sums() { return sums_; }
    /// and then this does so by bodies. all: the bodies
    Launch weigh(const Segments& all);
    void add_weigh_accesses(Step::Adding& task);

    /// [9 * (bodies + 1)] see the kernel
    Buffer<float4>& moments() { return moments_; }
    void add_reads(Step::Adding& task);

private:
    FreeBodies& bodies_;
    Buffer<int>& first_run_;
    Buffer<float>& counts_;
    MomentSums sums_;
    Buffer<float4> moments_;
};

}  // namespace weft
