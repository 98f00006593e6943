#include "simulation/output/geometry_writer.h"

#include <optional>
#include <stdexcept>
#include <utility>

#include "runtime/error.h"
#include "runtime/io/background_writer.h"
#include "runtime/io/hdf5/handle.h"
#include "simulation/output/chunk_codec.h"
#include "simulation/output/vtkhdf_file.h"
#include "simulation/output/xdmf_file.h"

namespace weft {

namespace {

struct Step {
    double time = 0.0;
    std::function<std::vector<float>()> positions;
};

std::vector<std::int32_t> body_of_each_triangle(const std::vector<GeometryBody>& bodies,
                                                std::size_t triangle_count) {
    std::vector<std::int32_t> numbers;
    numbers.reserve(triangle_count);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        numbers.insert(numbers.end(), bodies[i].triangle_count, static_cast<std::int32_t>(i));
    }
    if (numbers.size() != triangle_count) {
        throw std::invalid_argument("the bodies' triangles do not add up");
    }
    return numbers;
}

std::vector<std::string> names_of(const std::vector<GeometryBody>& bodies) {
    std::vector<std::string> names;
    for (const GeometryBody& body : bodies) names.push_back(body.name);
    return names;
}

}  // namespace

class GeometryWriter::Impl {
public:
    Impl(const std::filesystem::path& path, std::span<const Triangle> triangles,
         std::size_t vertex_count, const std::vector<GeometryBody>& bodies, std::size_t step_count,
         Compression compression)
        : path_(path.string()), value_count_(3 * vertex_count), codec_(compression) {
        const auto numbers = body_of_each_triangle(bodies, triangles.size());
        guarded([&] {
            file_.emplace(path_, triangles, vertex_count, numbers, names_of(bodies), step_count,
                          compression);
        });
        xdmf_.emplace(xdmf_path(path), path.filename().string(), triangles.size(), vertex_count);
        background_.emplace([this](Step& step) { write(step); });
    }

    void append(double time, std::vector<float> positions) {
        check(positions);
        append(time, [values = std::move(positions)]() mutable { return std::move(values); });
    }

    void append(double time, std::function<std::vector<float>()> positions) {
        if (appended_++ == file_->step_limit()) {
            throw std::invalid_argument("more steps than the geometry was made for");
        }
        background_->push({time, std::move(positions)});
    }

    void finish() {
        background_->drain();
        guarded([&] { file_->close(); });
        xdmf_->close();
    }

private:
    void check(const std::vector<float>& positions) const {
        if (positions.size() == value_count_) return;
        throw std::invalid_argument("positions do not fit the geometry's vertices");
    }

    /// What takes long, encoding, is done while others may use the library.
    void write(const Step& step) {
        const std::vector<float> positions = step.positions();
        check(positions);
        const auto encoded = codec_.encode(positions);
        guarded([&] { file_->append(step.time, encoded); });
        xdmf_->append(step.time, VtkhdfFile::step_dataset(file_->steps() - 1));
    }

    template <class Action>
    void guarded(Action action) {
        const hdf5::Session session;
        try {
            action();
        } catch (const hdf5::Error& error) {
            if (file_) file_->abandon();
            throw RunError(path_ + ": cannot write the geometry: " + error.what());
        }
    }

    const std::string path_;
    const std::size_t value_count_;
    ChunkCodec codec_;
    std::size_t appended_ = 0;
    std::optional<VtkhdfFile> file_;
    std::optional<XdmfFile> xdmf_;
    std::optional<BackgroundWriter<Step>> background_;
};

GeometryWriter::GeometryWriter(const std::filesystem::path& path,
                               std::span<const Triangle> triangles, std::size_t vertex_count,
                               const std::vector<GeometryBody>& bodies, std::size_t step_count,
                               Compression compression)
    : impl_(
          std::make_unique<Impl>(path, triangles, vertex_count, bodies, step_count, compression)) {}

GeometryWriter::~GeometryWriter() = default;

void GeometryWriter::append(double time, std::vector<float> positions) {
    impl_->append(time, std::move(positions));
}

void GeometryWriter::append(double time, std::function<std::vector<float>()> positions) {
    impl_->append(time, std::move(positions));
}

void GeometryWriter::finish() { impl_->finish(); }

std::filesystem::path GeometryWriter::xdmf_path(const std::filesystem::path& path) {
    return std::filesystem::path(path).replace_extension(".xdmf");
}

}  // namespace weft
