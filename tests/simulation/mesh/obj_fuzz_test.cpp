// Thousands of broken meshes: each is read or refused with UserError, and nothing else happens.
#include <random>

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "simulation/mesh/mesh_checks.h"
#include "simulation/mesh/obj_reader.h"

namespace weft {
namespace {

constexpr const char* kText =
    "# cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\ng a\n"
    "f 1/1/1 3/2/1 2/3/1\nf 1 4 3\nf 5 6 7\nf 5 7 8\ng b\nf -8 -7 -3\nf 1 6 5\nf 2//1 3//1 7//1\n";

const char* const kPieces[] = {"-1", "0",  "1e999", "nan", "/",  "\n",          "f ", "v ",
                               "\\", "\t", "#",     "-",   "e-", "99999999999", " 2"};

std::string mutated(std::string text, std::mt19937& random) {
    const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
    const std::size_t changes = 1 + below(5);
    for (std::size_t i = 0; i < changes; ++i) {
        const std::size_t at = below(text.size());
        switch (below(4)) {
            case 0:
                text.erase(at, 1 + below(10));
                break;
            case 1:
                text.insert(at, kPieces[below(std::size(kPieces))]);
                break;
            case 2:
                text.insert(at, text.substr(below(text.size()), below(40)));
                break;
            default:
                if (!text.empty()) text[at] = static_cast<char>(below(256));
        }
    }
    return text;
}

TEST(ObjFuzz, MutatedTextIsReadOrRefused) {
    std::mt19937 random(7);
    for (int i = 0; i < 20000; ++i) {
        Warnings warnings;
        try {
            TriangleMesh mesh = parse_obj(mutated(kText, random), "fuzz.obj", warnings);
            drop_duplicates(mesh, warnings);
            warn_of_odd_topology(mesh, warnings);
            for (const auto& triangle : mesh.triangles) {
                for (const int v : triangle) ASSERT_TRUE(v >= 0 && v < mesh.vertex_count());
            }
            check_areas(mesh);
        } catch (const UserError&) {
        }
    }
}

}  // namespace
}  // namespace weft
