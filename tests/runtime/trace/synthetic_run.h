#pragma once

#include <cstdint>

#include "runtime/trace/records.h"

/// A made-up run on two devices that looks like a real one: strips, two colours, seams between the
/// devices, measured times that scatter around the planned ones. Frame f is the same every time.
namespace weft::synthetic {

struct Shape {
    std::uint32_t substeps = 4;
    std::uint32_t iterations = 8;
    bool transfers = true;
    bool contacts = true;
};

RunDescription describe(const Shape& shape);
FrameRecord frame(const Shape& shape, std::uint32_t number);

}  // namespace weft::synthetic
