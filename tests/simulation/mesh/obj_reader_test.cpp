#include "simulation/mesh/obj_reader.h"

#include <gtest/gtest.h>

#include "runtime/error.h"

namespace weft {
namespace {

TriangleMesh read(std::string_view text) {
    Warnings warnings;
    TriangleMesh mesh = parse_obj(text, "m.obj", warnings);
    EXPECT_TRUE(warnings.empty());
    return mesh;
}

std::string message_of(std::string_view text) {
    try {
        read(text);
    } catch (const UserError& error) {
        return error.what();
    }
    return "no error";
}

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n";

TEST(ObjReader, ReadsWhatExportersWrite) {
    const TriangleMesh mesh = read(
        "# comment\r\nmtllib a.mtl\r\no shirt\r\nv +1.5 -2e-1 .5 1.0\r\nv 0 0 0\r\nv 1 0 0 # "
        "tail\r\n"
        "vt 0 0\r\nvn 0 1 0\r\ng left sleeve \r\nusemtl red\r\ns off\r\nf 1/1/1 2//1 3/1\r\n"
        "g right\r\nf -3 -1 -2");
    EXPECT_EQ(mesh.positions[0], (Vec3{1.5, -0.2, 0.5}));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<int, 3>>{{0, 1, 2}, {0, 2, 1}}));
    ASSERT_EQ(mesh.parts.size(), 2U);
    EXPECT_EQ(mesh.parts[0].name, "left sleeve");
    EXPECT_EQ(mesh.parts[1].name, "right");
    EXPECT_EQ(mesh.parts[1].first_triangle, 1);
}

TEST(ObjReader, ReadsFacesBeforeTheirVertices) {
    EXPECT_EQ(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 0 1\n").triangle_count(), 1);
}

TEST(ObjReader, ReadsNumbersThatOnlyDoublesMiss) {
    const TriangleMesh mesh = read("v 1e-400 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n");
    EXPECT_EQ(mesh.positions[0].x, 0.0);
}

TEST(ObjReader, ExplainsWhatIsWrongAndWhere) {
    const std::string t(kTriangle);
    EXPECT_EQ(message_of(t + "v 1 0 1\nf 1 3 2 4\n").find("m.obj:6: face with 4 corners crosses"),
              0U);
    EXPECT_EQ(message_of(t + "v 1 0 1\nf 1 2 3 2 4\n"),
              "m.obj:6: degenerate face: vertex 2 is named twice");
    EXPECT_EQ(message_of(t + "v 2 0 0\nv 3 0 0\nf 1 2 4 5\n").find("m.obj:7: face with 4 corners"),
              0U);
    EXPECT_EQ(message_of(t + "f 1 2 \\\n3\n").find("m.obj:5: a line continued by"), 0U);
    EXPECT_EQ(message_of(t + "f 1 2\n").find("m.obj:5: face with 2 corners"), 0U);
    EXPECT_EQ(message_of(t + "f 0 1 2\n").find("m.obj:5: vertex index 0 is out of range"), 0U);
    EXPECT_EQ(message_of(t + "f 1 2 -4\n").find("m.obj:5: vertex index -4 is out of range"), 0U);
    EXPECT_EQ(message_of(t + "f 1 2 9\nf 3 2 1\n"),
              "m.obj:5: vertex index 9 is out of range: the file has 3 vertices, counted from 1");
    EXPECT_EQ(message_of(t + "f 1 2 99999999999999999999\n").find("m.obj:5: "), 0U);
    EXPECT_EQ(message_of(t + "f 1 2 9999999999\n").find("m.obj:5: vertex index 9999999999"), 0U);
    EXPECT_EQ(message_of(t + "f 1 2 x\n"), "m.obj:5: 'x': expected a vertex index");
    EXPECT_EQ(message_of(t + "f 1 2 2\n"), "m.obj:5: degenerate face: vertex 2 is named twice");
    EXPECT_EQ(message_of("v 0 nan 0\n" + t),
              "m.obj:1: coordinate y = 'nan': must be finite and within 1000000 m");
    EXPECT_EQ(message_of("v 0 0 -inf\n" + t).find("m.obj:1: coordinate z = '-inf': must be"), 0U);
    EXPECT_EQ(message_of("v 1e999 0 0\n" + t).find("m.obj:1: coordinate x = '1e999': must be"), 0U);
    EXPECT_EQ(message_of("v 0 1,5 0\n" + t), "m.obj:1: coordinate y = '1,5': expected a number");
    EXPECT_EQ(message_of("v 0 0\n" + t).find("m.obj:1: a vertex needs three coordinates"), 0U);
    EXPECT_EQ(message_of(""), "m.obj: has no vertices ('v' lines)");
    EXPECT_EQ(message_of("v 0 0 0\n"), "m.obj: has no faces ('f' lines)");
}

TEST(ObjReader, WarnsOfUnknownLines) {
    Warnings warnings;
    parse_obj(std::string(kTriangle) + "hello world\n", "m.obj", warnings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0], "m.obj: 1 lines with unknown keywords passed over");
}

TEST(ObjReader, SplitsFacesWithMoreCorners) {
    const TriangleMesh mesh = read(
        "v 0 0 0\nv 2 0 0\nv 3 1 0\nv 0 1 0\nv 1 3 0\n"
        "g quad\nf 1 2 3 4\ng roof\nf 4/1 3/2 5/3\nf 1 1 2 4\ng all\nf 1 2 3 5 4\n");
    using Triangles = std::vector<std::array<int, 3>>;
    // The quad along its shorter diagonal, the fourth corner of the second triangle dropped.
    EXPECT_EQ(Triangles(mesh.triangles.begin(), mesh.triangles.begin() + 4),
              (Triangles{{1, 2, 3}, {0, 1, 3}, {3, 2, 4}, {0, 1, 3}}));
    ASSERT_EQ(mesh.parts.size(), 3U);
    EXPECT_EQ(mesh.parts[1].first_triangle, 2);
    EXPECT_EQ(mesh.parts[1].triangle_count, 2);
    EXPECT_EQ(mesh.parts[2].triangle_count, 3);
}

TEST(ObjReader, NamesVerticesByObjectGroupAndEachOfItsWords) {
    const NamedVertices parts =
        named_parts(read("v 0 0 0\nv 1 0 0\nv 0 0 1\nv 1 0 1\no shirt\ng left sleeve\nf 1 3 2\n"
                         "g right sleeve\nf 2 3 4\no hem\nf 4 3 1\n"));
    EXPECT_EQ(parts.at("shirt"), (std::vector{0, 1, 2, 3}));
    EXPECT_EQ(parts.at("left sleeve"), (std::vector{0, 1, 2}));
    EXPECT_EQ(parts.at("right"), (std::vector{1, 2, 3}));
    EXPECT_EQ(parts.at("sleeve"), (std::vector{0, 1, 2, 3}));
    EXPECT_EQ(parts.at("hem"), (std::vector{0, 2, 3}));
    EXPECT_EQ(parts.size(), 7U);
}

TEST(ObjReader, RefusesOtherFormatsByTheirName) {
    Warnings warnings;
    const auto refusal = [&](const std::string& path) {
        try {
            read_obj(path, warnings);
        } catch (const UserError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(refusal("a/shirt.PLY"),
              "a/shirt.PLY: PLY is not read here: a cloth's mesh must be a Wavefront OBJ (.obj) "
              "file; export it as one");
    EXPECT_EQ(refusal("shirt.glb").find("shirt.glb: glTF is not read here: "), 0U);
    EXPECT_EQ(refusal("shirt").find("shirt: a cloth's mesh must be"), 0U);
}

TEST(ObjReader, RefusesMissingFilesAndFolders) {
    Warnings warnings;
    EXPECT_THROW(read_obj("no/such.obj", warnings), UserError);
    EXPECT_THROW(read_obj(".", warnings), UserError);
}

/// They belong to corners, not to vertices, and follow a face's corners when it is split.
TEST(ObjReader, KeepsTextureCoordinatesOfCorners) {
    const TriangleMesh mesh = read(
        "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nv 2 0 0\nvt 0.5 1\nvt 1 2 9\nvt 3\nvt 4 4\n"
        "f 1/1 2/2 3/3 4/-1\nf 2/4/7 5/1 3/3\n");
    ASSERT_EQ(mesh.texture.size(), mesh.triangles.size());
    const std::array<std::array<double, 2>, 4> of_quad{{{0.5, 1}, {1, 2}, {3, 0}, {4, 4}}};
    for (std::size_t t = 0; t < 2; ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(mesh.texture[t][k], of_quad[static_cast<std::size_t>(mesh.triangles[t][k])]);
        }
    }
    EXPECT_EQ(mesh.texture[2], (std::array<std::array<double, 2>, 3>{{{4, 4}, {0.5, 1}, {3, 0}}}));
}

TEST(ObjReader, HasNoTextureCoordinatesWhereACornerHasNone) {
    const std::string square = "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n";
    for (const char* faces : {"f 1/1 2/2 3/3\nf 1/1 3/3 4\n", "f 1/1 2/2 3/4\n", "f 1/1 2/2 3/-4\n",
                              "f 1/x 2/2 3/3\n"}) {
        Warnings warnings;
        EXPECT_TRUE(parse_obj(square + faces, "m.obj", warnings).texture.empty()) << faces;
    }
    Warnings warnings;
    parse_obj(square + "f 1/1 2/2 3/4\n", "m.obj", warnings);
    ASSERT_EQ(warnings.size(), 1U);
    EXPECT_EQ(warnings[0],
              "m.obj:8: texture coordinates that are not there, or no numbers; all of them are "
              "passed over");
}

}  // namespace
}  // namespace weft
