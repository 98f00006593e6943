#pragma once

#include <string>
#include <vector>

#include "runtime/io/hdf5/datasets.h"

namespace weft {

/// One member of all points of a curve, as a dataset of ints or doubles.
template <class Stored, class Point, class Value>
void write_column(hid_t group, const std::string& name, const std::vector<Point>& points,
                  Value Point::*member) {
    std::vector<Stored> values;
    values.reserve(points.size());
    for (const Point& point : points) values.push_back(static_cast<Stored>(point.*member));
    hdf5::write_numbers(group, name, std::span<const Stored>(values));
}

}  // namespace weft
