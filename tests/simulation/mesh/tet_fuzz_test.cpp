// Thousands of broken meshes: each is read or refused with UserError, and nothing else happens.
#include <random>

#include <gtest/gtest.h>

#include "runtime/error.h"
#include "simulation/mesh/tet_checks.h"
#include "simulation/mesh/tet_reader.h"
#include "tests/mutation.h"
#include "tests/simulation/mesh/tet_texts.h"

namespace weft {
namespace {

const char* const kPieces[] = {"-1", "0", "1e999", "nan", "$",       "\n",          "$End", " 4 ",
                               "\t", "#", "-",     "e-",  "OFFSETS", "99999999999", " 2"};

TEST(TetFuzz, MutatedTextIsReadOrRefused) {
    std::mt19937 random(11);
    int read = 0;
    for (int i = 0; i < 20000; ++i) {
        const std::string* const texts[] = {&test::kMsh2, &test::kMsh4, &test::kVtk2, &test::kVtk5};
        const std::string text = test::mutated(*texts[i % 4], random, kPieces);
        Warnings warnings;
        try {
            TetMesh mesh = i % 4 < 2 ? parse_msh(text, "fuzz.msh") : parse_vtk(text, "fuzz.vtk");
            for (const auto& tetrahedron : mesh.tetrahedra) {
                for (const int v : tetrahedron) ASSERT_TRUE(v >= 0 && v < mesh.vertex_count());
            }
            ++read;
            drop_duplicates(mesh, warnings);
            turn_inverted(mesh, warnings);
            warn_of_odd_topology(mesh, warnings);
            EXPECT_FALSE(boundary_faces(mesh).empty());
            check_volumes(mesh);
        } catch (const UserError& error) {
            EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        }
    }
    EXPECT_GT(read, 1000) << "not all is refused at once";
}

}  // namespace
}  // namespace weft
