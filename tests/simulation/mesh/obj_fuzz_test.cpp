// Thousands of broken meshes: each is read or refused with UserError, and nothing else happens.
#include <random>

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "simulation/mesh/mesh_checks.h"
#include "simulation/mesh/obj_reader.h"
#include "tests/mutation.h"

namespace weft {
namespace {

constexpr const char* kText =
    "# cube\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\ng a\n"
    "f 1/1/1 3/2/1 2/3/1\nf 1 4 3\nf 5 6 7\nf 5 7 8\ng b\nf -8 -7 -3\nf 1 6 5\nf 2//1 3//1 7//1\nf "
    "1 2 3 4\no c\nf 5 6 7 8 4\n";

const char* const kPieces[] = {"-1", "0",  "1e999", "nan", "/",  "\n",          "f ", "v ",
                               "\\", "\t", "#",     "-",   "e-", "99999999999", " 2"};

TEST(ObjFuzz, MutatedTextIsReadOrRefused) {
    std::mt19937 random(7);
    for (int i = 0; i < 20000; ++i) {
        Warnings warnings;
        try {
            TriangleMesh mesh =
                parse_obj(test::mutated(kText, random, kPieces), "fuzz.obj", warnings);
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
