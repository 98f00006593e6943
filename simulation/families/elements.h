#pragma once

#include <array>
#include <string>

#include "runtime/launch.h"
#include "runtime/unused_memory.h"
#include "simulation/topology/layout.h"

namespace weft {

/// The most corners that an element has.
inline constexpr int kMaxCorners = 4;

/// The vertices of one element.
class ElementCorners {
public:
    void push_back(int vertex) { vertices_[count_++] = vertex; }

    std::size_t size() const { return count_; }
    const int* begin() const { return vertices_.data(); }
    const int* end() const { return vertices_.data() + count_; }
    int operator[](std::size_t corner) const { return vertices_[corner]; }

private:
    std::array<int, kMaxCorners> vertices_{};
    std::size_t count_ = 0;
};

/// The elements of one kind as kernels want them: sorted by (phase, strip, colour), column-major.
class Elements {
public:
    Elements(const std::string& name, const Stencils& stencils, const Strips& strips);

    int count() const { return count_; }
    int arity() const { return arity_; }
    /// All of them, in the new order of vertices: a copy.
    Stencils stencils() const;
    /// The vertices of an element, in the new order of vertices.
    ElementCorners vertices_of(int element) const {
        ElementCorners corners;
        for (int k = 0; k < arity_; ++k) corners.push_back(vertex_of(element, k));
        return corners;
    }
    int vertex_of(int element, int corner) const {
        return vertices_[static_cast<std::size_t>(corner * count_ + element)];
    }
    /// New element -> element as it was given; for those who make their tables.
    int original(int element) const { return order_[static_cast<std::size_t>(element)]; }
    /// All tables are made.
    void forget_originals() { give_back(order_); }

    /// [arity * count] column-major
    Buffer<int>& vertices() { return vertices_; }
    const Buffer<int>& vertices() const { return vertices_; }
    /// The elements of a phase.
    const Segments& segments(Phase phase) const { return segments_[phase]; }

private:
    Elements(const std::string& name, ElementLayout layout);

    int arity_;
    int count_;
    std::vector<int> order_;  ///< [count] empty: forgotten
    Buffer<int> vertices_;
    Buffer<int> segment_begin_;
    std::array<Segments, kPhaseCount> segments_;
};

}  // namespace weft
