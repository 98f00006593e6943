#include "benchmarks/simulation/plain_springs.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace weft {

PlainSprings::PlainSprings(std::vector<Particle> particles, const Stencils& edges, float compliance)
    : particles_(std::move(particles)), compliance_(compliance) {
    // Greedy colours; 32 are more than any sensible cloth needs.
    std::vector<std::uint32_t> used(particles_.size(), 0);
    std::vector<std::vector<Spring>> colours(32);
    for (int e = 0; e < edges.count(); ++e) {
        const auto a = static_cast<std::size_t>(edges[e][0]);
        const auto b = static_cast<std::size_t>(edges[e][1]);
        const std::uint32_t taken = used[a] | used[b];
        std::size_t colour = 0;
        while ((taken >> colour & 1U) != 0) ++colour;
        used[a] |= 1U << colour;
        used[b] |= 1U << colour;
        const float dx = particles_[a].x - particles_[b].x;
        const float dy = particles_[a].y - particles_[b].y;
        const float dz = particles_[a].z - particles_[b].z;
        colours[colour].push_back(
            {edges[e][0], edges[e][1], std::sqrt(dx * dx + dy * dy + dz * dz), 0.0f});
    }
    for (const auto& colour : colours)
        springs_.insert(springs_.end(), colour.begin(), colour.end());
}

void PlainSprings::sweep(float inverse_h2) {
    const float alpha = compliance_ * inverse_h2;
    for (Spring& s : springs_) {
        Particle& a = particles_[static_cast<std::size_t>(s.a)];
        Particle& b = particles_[static_cast<std::size_t>(s.b)];
        const float dx = a.x - b.x;
        const float dy = a.y - b.y;
        const float dz = a.z - b.z;
        const float length = std::sqrt(dx * dx + dy * dy + dz * dz);
        const float weight = a.inverse_mass + b.inverse_mass;
        if (length <= 0.0f || weight == 0.0f) continue;
        const float change = (s.rest_length - length - alpha * s.multiplier) / (weight + alpha);
        s.multiplier += change;
        const float push = change / length;
        a.x += push * a.inverse_mass * dx;
        a.y += push * a.inverse_mass * dy;
        a.z += push * a.inverse_mass * dz;
        b.x -= push * b.inverse_mass * dx;
        b.y -= push * b.inverse_mass * dy;
        b.z -= push * b.inverse_mass * dz;
    }
}

}  // namespace weft
