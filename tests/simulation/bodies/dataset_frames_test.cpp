#include "simulation/bodies/dataset_frames.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "runtime/error.h"
#include "runtime/io/hdf5/datasets.h"
#include "runtime/io/hdf5/files.h"
#include "runtime/io/hdf5/growing_dataset.h"

namespace weft {
namespace {

namespace fs = std::filesystem;

MeshObstacle obstacle_of(const std::string& frames) {
    MeshObstacle obstacle;
    obstacle.name = "body";
    obstacle.frames = frames;
    obstacle.where = "s.toml:3:1";
    return obstacle;
}

TEST(FrameDataset, IsNamedByTheEndingOfItsFile) {
    const auto parts = [](const std::string& frames) {
        const auto dataset = frame_dataset(obstacle_of(frames));
        return dataset ? dataset->file + " | " + dataset->path : "none";
    };
    EXPECT_EQ(parts("a/body.h5"), "a/body.h5 | ");
    EXPECT_EQ(parts("a/body.h5:/x/y"), "a/body.h5 | /x/y");
    EXPECT_EQ(parts("BODY.HDF5:x"), "BODY.HDF5 | x");
    EXPECT_EQ(parts("a.h5:/b.hdf5"), "a.h5 | /b.hdf5");
    EXPECT_EQ(parts("a.hdf5:/b.h5"), "a.hdf5 | /b.h5");
    for (const char* other : {"", "body_*.obj", "body.h5.obj", "body_h5", "run.h5/body_*.obj"}) {
        EXPECT_EQ(parts(other), "none") << other;
    }
}

class DatasetFrames : public testing::Test {
protected:
    DatasetFrames() {
        std::iota(values_.begin(), values_.end(), 0.5);
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }

    /// Five frames of two vertices, as `type`; rows_per_chunk: 0 where they lie in one piece.
    void write(hid_t type, hsize_t rows_per_chunk) const {
        const hdf5::Session session;
        const hdf5::Handle file = hdf5::create_file(path_, hdf5::FileFormat::kPlain);
        if (rows_per_chunk == 0) {
            const hsize_t shape[] = {5, 2, 3};
            const hdf5::Handle points =
                hdf5::write_array(file.id(), "points", H5T_NATIVE_DOUBLE, shape, values_.data());
        } else {
            hdf5::GrowingDataset points(file.id(), "points", type, {2, 3}, rows_per_chunk, 1);
            points.append(H5T_NATIVE_DOUBLE, values_.data(), 5);
            points.close();
        }
        hdf5::publish(path_);
    }

    std::vector<std::vector<Vec3>> read(std::size_t vertices = 2) const {
        const MeshObstacle obstacle = obstacle_of(path_);
        return read_dataset_frames(obstacle, *frame_dataset(obstacle), vertices);
    }

    std::string message(std::size_t vertices = 2) const {
        try {
            read(vertices);
        } catch (const UserError& error) {
            return error.what();
        }
        return "no error";
    }

    void expect_values() const {
        const auto frames = read();
        ASSERT_EQ(frames.size(), 5U);
        for (std::size_t f = 0; f < 5; ++f) {
            ASSERT_EQ(frames[f].size(), 2U);
            const auto x = 0.5 + 6.0 * static_cast<double>(f);
            EXPECT_EQ(frames[f][0], (Vec3{x, x + 1, x + 2}));
            EXPECT_EQ(frames[f][1], (Vec3{x + 3, x + 4, x + 5}));
        }
    }

    std::vector<double> values_ = std::vector<double>(30);
    fs::path folder_ = fs::path(testing::TempDir()) / "weft_dataset_frames";
    std::string path_ = (folder_ / "body.h5").string();
};

TEST_F(DatasetFrames, AreReadHoweverTheyAreStored) {
    for (const hsize_t rows_per_chunk : {0, 1, 2, 5, 100}) {
        write(H5T_IEEE_F64BE, rows_per_chunk);
        expect_values();
    }
    write(H5T_IEEE_F32LE, 2);
    expect_values();
    write(H5T_IEEE_F32BE, 2);
    expect_values();
}

TEST_F(DatasetFrames, AreOfTheMeshsVertices) {
    write(H5T_IEEE_F32LE, 2);
    EXPECT_EQ(message(3), "s.toml:3:1: motion.frames = \"" + path_ +
                              "\": the file has '/points' (5, 2, 3) of floats; expected (frames, "
                              "3, 3) of floats, as obstacle 'body' has 3 vertices");
    write(H5T_STD_I32LE, 2);
    EXPECT_NE(message().find("(5, 2, 3) of integers"), std::string::npos);
}

TEST_F(DatasetFrames, MustBePlaces) {
    values_[4 * 6 + 3 + 2] = -2e6;
    write(H5T_IEEE_F64LE, 2);
    EXPECT_NE(message().find("'/points'[4, 1] = (27.5, 28.5, -2000000): must be finite and within"),
              std::string::npos);
}

/// The library would make up zeros for what is missing, if it were asked to read on.
TEST_F(DatasetFrames, AreNotReadFromAFileThatWasCutOff) {
    write(H5T_IEEE_F64LE, 0);
    const auto whole = fs::file_size(path_);
    for (const auto size : {whole - 1, whole - 100, whole / 2, std::uintmax_t{40}}) {
        fs::resize_file(path_, size);
        EXPECT_NE(message().find("cannot read it as HDF5: open: "), std::string::npos) << size;
    }
    fs::remove(path_);
    EXPECT_NE(message().find("no such file"), std::string::npos);
}

}  // namespace
}  // namespace weft
