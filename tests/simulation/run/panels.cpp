#include "tests/simulation/run/panels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <random>

#include <fmt/format.h>

namespace weft::test {

namespace {

constexpr int kSide = 11;

std::string faces(const std::string& name, const std::vector<std::array<int, 3>>& triangles) {
    std::string text = "g " + name + "\n";
    for (const auto& t : triangles) {
        text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
    }
    return text;
}

std::string vertex(Vec3 p) { return fmt::format("v {:.9g} {:.9g} {:.9g}\n", p.x, p.y, p.z); }

}  // namespace

Panels Panels::make() {
    Panels panels;
    std::mt19937 random(5);
    const auto jitter = [&] { return 0.03 * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
    for (int k = 0; k < kSide; ++k) {
        for (int i = 0; i < kSide; ++i) {
            panels.positions.push_back({0.1 * i + jitter(), jitter(), 0.1 * k + jitter()});
        }
    }
    for (int k = 0; k + 1 < kSide; ++k) {
        // The cut is no straight line, but a zigzag.
        const int middle = kSide / 2 - k % 3;
        for (int i = 0; i + 1 < kSide; ++i) {
            const int v = k * kSide + i;
            auto& half = i < middle ? panels.left : panels.right;
            if (random() % 2 == 0) {
                half.push_back({v, v + kSide, v + 1});
                half.push_back({v + 1, v + kSide, v + kSide + 1});
            } else {
                half.push_back({v, v + kSide, v + kSide + 1});
                half.push_back({v, v + kSide + 1, v + 1});
            }
        }
    }
    std::vector<char> is_left(panels.positions.size(), 0), is_right(is_left);
    for (const auto& t : panels.left) {
        for (const int v : t) is_left[static_cast<std::size_t>(v)] = 1;
    }
    for (const auto& t : panels.right) {
        for (const int v : t) is_right[static_cast<std::size_t>(v)] = 1;
    }
    int next = kSide * kSide;
    for (int v = 0; v < kSide * kSide; ++v) {
        const auto at = static_cast<std::size_t>(v);
        if (is_left[at] != 0 && is_right[at] != 0) panels.cut.push_back({v, next++});
    }
    return panels;
}

std::string Panels::whole_obj() const {
    std::string text;
    for (const Vec3 p : positions) text += vertex(p);
    return text + faces("left", left) + faces("right", right);
}

std::string Panels::cut_obj() const { return cut_obj(0.0); }

std::string Panels::cut_obj(double apart) const {
    std::map<int, int> own;
    for (const auto& [a, b] : cut) own[a] = b;
    std::vector<char> moves(positions.size(), 0);
    std::vector<std::array<int, 3>> cut_right = right;
    for (auto& t : cut_right) {
        for (int& v : t) {
            if (own.contains(v)) {
                v = own[v];
            } else {
                moves[static_cast<std::size_t>(v)] = 1;
            }
        }
    }
    std::string text;
    const Vec3 away{apart, 0.0, 0.0};
    for (std::size_t v = 0; v < positions.size(); ++v) {
        text += vertex(moves[v] != 0 ? positions[v] + away : positions[v]);
    }
    for (const auto& [a, b] : cut) text += vertex(positions[static_cast<std::size_t>(a)] + away);
    return text + faces("left", left) + faces("right", cut_right);
}

std::string write_obj(const std::string& name, const std::string& text) {
    const std::string path = testing::TempDir() + name;
    std::ofstream(path) << text;
    return path;
}

}  // namespace weft::test
