#include "simulation/output/geometry_writer.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "runtime/error.h"
#include "runtime/io/hdf5/attributes.h"
#include "runtime/io/hdf5/files.h"
#include "simulation/output/geometry_reader.h"

namespace weft {
namespace {

using Triangle = GeometryWriter::Triangle;

class Geometry : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(testing::TempDir()) /
                  testing::UnitTest::GetInstance()->current_test_info()->name();
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
        path_ = folder_ / "frames.vtkhdf";
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string xdmf() const {
        std::ifstream stream(GeometryWriter::xdmf_path(path_));
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    /// Number of steps as VTK reads it.
    int steps() const {
        // A copy, since HDF5 would show this process what it holds in memory of the file itself.
        const auto copy = folder_ / "copy.vtkhdf";
        std::filesystem::copy_file(path_, copy, std::filesystem::copy_options::overwrite_existing);
        const hdf5::Session session;
        const hdf5::Handle file = hdf5::open_to_read(copy.string());
        const hdf5::Handle group(H5Gopen2(file.id(), "/VTKHDF/Steps", H5P_DEFAULT), H5Gclose,
                                 "open");
        return hdf5::read_int_attribute(group.id(), "NSteps");
    }

    const std::vector<Triangle> triangles_ = {{0, 1, 2}, {2, 1, 3}};
    const std::vector<GeometryBody> bodies_ = {{"first", 1}, {"second", 1}};
    std::filesystem::path folder_;
    std::filesystem::path path_;
};

TEST_F(Geometry, FilesAreWholeAfterEveryStep) {
    GeometryWriter writer(path_, triangles_, 4, bodies_, 10);
    EXPECT_EQ(steps(), 0);
    const std::vector<float> positions(12, 0.5F);
    for (int i = 0; i < 5; ++i) {
        writer.append(i, positions);
        EXPECT_GE(steps(), i);
        EXPECT_TRUE(xdmf().ends_with("</Xdmf>\n"));
    }
    writer.finish();
    EXPECT_EQ(steps(), 5);
    EXPECT_NE(xdmf().find("frames.vtkhdf:/weft/positions_4"), std::string::npos);
}

/// Of every kind: as noise, as a smooth sheet, and at rest; fewer and more bytes than a block of
/// deflate has.
std::vector<std::vector<float>> samples(std::size_t vertices) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1e3F, 1e3F);
    std::vector<std::vector<float>> samples(3, std::vector<float>(3 * vertices));
    for (float& value : samples[0]) value = uniform(random);
    for (std::size_t i = 0; i < samples[1].size(); ++i)
        samples[1][i] = std::sin(1e-3F * static_cast<float>(i));
    return samples;
}

TEST_F(Geometry, EveryCompressionReadsBackTheSame) {
    const std::vector<Triangle> triangle{{0, 0, 0}};
    for (const std::size_t vertices : {1U, 7U, 10922U, 10923U, 50000U}) {
        const auto written = samples(vertices);
        std::vector<std::uintmax_t> sizes;
        for (const std::string& name : compression_names()) {
            GeometryWriter writer(path_, triangle, vertices, {{"body", 1}}, written.size(),
                                  compression_named(name));
            for (std::size_t i = 0; i < written.size(); ++i)
                writer.append(static_cast<double>(i), written[i]);
            writer.finish();
            const GeometryReader reader(path_);
            ASSERT_EQ(reader.steps(), written.size());
            for (std::size_t i = 0; i < written.size(); ++i)
                EXPECT_EQ(reader.positions(i), written[i]) << name << ", step " << i;
            sizes.push_back(std::filesystem::file_size(path_));
        }
        if (vertices < 10000U) continue;
        EXPECT_GT(sizes[0], sizes[1]);
        EXPECT_GT(sizes[1], sizes[2]);
    }
}

/// As a run leaves it that is killed after it counted a step, and before it wrote its time.
TEST_F(Geometry, StepsWithoutTimesAreNotRead) {
    {
        GeometryWriter writer(path_, triangles_, 4, bodies_, 3);
        for (int i = 0; i < 3; ++i) writer.append(i, std::vector<float>(12, 0.5F));
        writer.finish();
    }
    {
        const hdf5::Session session;
        const hdf5::Handle file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose,
                                "open");
        const hdf5::Handle times(H5Dopen2(file.id(), "VTKHDF/Steps/Values", H5P_DEFAULT), H5Dclose,
                                 "open");
        const hsize_t written[] = {2};
        hdf5::check(H5Dset_extent(times.id(), written), "shorten");
    }
    const GeometryReader reader(path_);
    EXPECT_EQ(reader.steps(), 2U);
    EXPECT_EQ(reader.time(1), 1.0);
}

TEST_F(Geometry, ReplacesOldFiles) {
    const std::vector<float> positions(12, 0.5F);
    for (int steps_now : {3, 1}) {
        GeometryWriter writer(path_, triangles_, 4, bodies_, 3);
        for (int i = 0; i < steps_now; ++i) writer.append(i, positions);
        writer.finish();
        EXPECT_EQ(steps(), steps_now);
    }
    EXPECT_EQ(xdmf().find("positions_1"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(path_.string() + ".part"));
}

TEST_F(Geometry, RefusesWhatDoesNotFit) {
    EXPECT_THROW(GeometryWriter(path_, triangles_, 4, {{"first", 1}}, 1), std::invalid_argument);
    GeometryWriter writer(path_, triangles_, 4, bodies_, 1);
    EXPECT_THROW(writer.append(0.0, std::vector<float>(11)), std::invalid_argument);
    writer.append(0.0, std::vector<float>(12));
    EXPECT_THROW(writer.append(1.0, std::vector<float>(12)), std::invalid_argument);
}

TEST_F(Geometry, UnwritablePlacesAreRunErrors) {
    const auto missing = folder_ / "missing" / "frames.vtkhdf";
    try {
        GeometryWriter writer(missing, triangles_, 4, bodies_, 1);
        FAIL();
    } catch (const RunError& error) {
        EXPECT_EQ(error.what(), missing.string() +
                                    ": cannot write the geometry: create: No such "
                                    "file or directory");
    }
}

/// A limit on the size of files stands for a full disk: both fail the same system call.
TEST_F(Geometry, FullDiskKeepsTheStepsBefore) {
    constexpr std::size_t kVertices = 20000;
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    rlimit limit = before;
    limit.rlim_cur = 1 << 20;
    std::signal(SIGXFSZ, SIG_IGN);

    std::mt19937 random(1);
    std::uniform_real_distribution<float> uniform;
    std::vector<float> positions(3 * kVertices);
    std::string message;
    {
        GeometryWriter writer(path_, triangles_, kVertices, bodies_, 100);
        setrlimit(RLIMIT_FSIZE, &limit);
        try {
            for (int i = 0; i < 100; ++i) {
                for (float& value : positions) value = uniform(random);
                writer.append(i, positions);
            }
        } catch (const RunError& error) {
            message = error.what();
        }
    }
    setrlimit(RLIMIT_FSIZE, &before);
    EXPECT_NE(message.find("cannot write the geometry: write positions: File too large"),
              std::string::npos)
        << message;
    EXPECT_GE(steps(), 3);
    EXPECT_LT(steps(), 10);
}

}  // namespace
}  // namespace weft
