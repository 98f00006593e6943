#include "simulation/cloth_scene.h"

#include "runtime/error.h"
#include "simulation/scene/read_scene.h"
#include "simulation/simulation.h"

namespace weft {

namespace {

std::vector<Override> overrides_of(const ClothOptions& options) {
    std::vector<Override> list;
    for (const std::string& text : options.overrides) list.push_back({text, "override " + text});
    return list;
}

}  // namespace

class ClothScene::Impl {
public:
    Impl(const Scene& scene, const ClothOptions& options)
        : frames_(scene.frames), simulation_(scene, options_of(options), warnings_) {}

    static SimulationOptions options_of(const ClothOptions& options) {
        SimulationOptions own;
        own.devices = options.devices;
        own.cost_file = options.cost_file;
        return own;
    }

    Simulation& simulation() { return simulation_; }
    const Model& model() const { return simulation_.model(); }
    int frames() const { return frames_; }

    std::vector<std::string> warnings() const {
        std::vector<std::string> list = warnings_;
        for (const Trouble& trouble : simulation_.troubles()) list.push_back(trouble.what);
        for (const LostDevice& lost : simulation_.losses()) list.push_back(lost.why);
        return list;
    }

    void check_vertices(int first, int count) const {
        const int all = model().vertex_count();
        if (first >= 0 && count >= 0 && first <= all - count) return;
        throw Misuse("vertices [" + std::to_string(first) + ", " + std::to_string(first + count) +
                     "): the scene has " + std::to_string(all));
    }

    void check_size(std::span<const float> xyz, const char* what) const {
        const auto wanted = 3 * static_cast<std::size_t>(model().vertex_count());
        if (xyz.size() == wanted) return;
        throw Misuse(std::string(what) + ": " + std::to_string(xyz.size()) + " values for " +
                     std::to_string(wanted));
    }

private:
    int frames_;
    Warnings warnings_;
    Simulation simulation_;
};

ClothScene::ClothScene(const std::filesystem::path& file, const ClothOptions& options)
    : ClothScene(
          std::make_unique<Impl>(read_scene(file.string(), overrides_of(options)), options)) {}

ClothScene::ClothScene(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ClothScene::~ClothScene() = default;
ClothScene::ClothScene(ClothScene&&) noexcept = default;

ClothScene ClothScene::from_text(const std::string& text, const std::string& name,
                                 const ClothOptions& options) {
    return ClothScene(
        std::make_unique<Impl>(parse_scene(text, name, overrides_of(options)), options));
}

void ClothScene::step() { impl_->simulation().advance({.tasks = false}); }
int ClothScene::frame() const { return impl_->simulation().frame(); }
int ClothScene::frame_count() const { return impl_->frames(); }
double ClothScene::time() const { return impl_->simulation().time(); }
double ClothScene::frame_time() const { return impl_->model().scene.dt; }
int ClothScene::vertex_count() const { return impl_->model().vertex_count(); }
std::vector<std::array<int, 3>> ClothScene::triangles() const { return impl_->model().triangles; }
std::vector<float> ClothScene::positions() const {
    return impl_->model().in_scene(impl_->simulation().positions());
}
std::vector<float> ClothScene::velocities() const { return impl_->simulation().velocities(); }
std::string ClothScene::state_hash() const { return impl_->simulation().hash(); }
std::vector<std::string> ClothScene::warnings() const { return impl_->warnings(); }

std::vector<ClothBody> ClothScene::bodies() const {
    std::vector<ClothBody> list;
    for (const BodyRange& body : impl_->model().bodies) {
        list.push_back({body.name, body.first_vertex, body.vertex_count});
    }
    return list;
}

void ClothScene::set_state(std::span<const float> positions, std::span<const float> velocities) {
    impl_->check_size(positions, "positions");
    impl_->check_size(velocities, "velocities");
    const std::vector<float> from_origin =
        impl_->model().from_origin({positions.begin(), positions.end()});
    impl_->simulation().start_from(frame(), from_origin, velocities);
}

void ClothScene::push(int first, int count, const std::array<float, 3>& velocity) {
    impl_->check_vertices(first, count);
    std::vector<float> velocities = this->velocities();
    for (int v = first; v < first + count; ++v) {
        for (int axis = 0; axis < 3; ++axis) {
            velocities[static_cast<std::size_t>(3 * v + axis)] +=
                velocity[static_cast<std::size_t>(axis)];
        }
    }
    impl_->simulation().start_from(frame(), impl_->simulation().positions(), velocities);
}

}  // namespace weft
