#include "simulation/choice/async_choice.h"

#include <fmt/format.h>

#include "simulation/choice/async_offer.h"
#include "simulation/scene/method.h"

namespace weft {

namespace {

bool has_asynchronous_form(LiveModel& live) { return !live.solver().asynchrony().kinds.empty(); }

bool has_several_devices(LiveModel& live) {
    return live.planned().division_by_units().devices().size() > 1;
}

/// Where several devices could share the scene, and nobody has said how. Whoever measures single
/// steps chooses by himself.
bool is_open(const SimulationOptions& options, LiveModel& live) {
    return options.plan == PlanKind::kAuto && !options.division && options.iterates == 1 &&
           options.on_trouble != OnTrouble::kIgnore && has_several_devices(live) &&
           has_asynchronous_form(live);
}

std::string why_not_open(LiveModel& live) {
    if (!has_asynchronous_form(live)) {
        return fmt::format("{} has no asynchronous form in this scene",
                           name_of(live.model().scene.solver.method));
    }
    if (!has_several_devices(live)) return "one device has nobody to wait for";
    return "it is said who does what";
}

}  // namespace

AsyncChoice choose_async(const SimulationOptions& options, LiveModel& live) {
    if (!is_open(options, live)) {
        const bool is_asked = options.may_be_async && options.plan == PlanKind::kAuto;
        return {{}, is_asked ? "not async: " + why_not_open(live) : ""};
    }
    AsyncSettings settings = options.async;
    settings.tasks = AsyncSettings::Tasks::kStrips;
    const AsyncOffer offer({live.model(), live.solver(), live.planned().next(),
                            live.planned().planner().timing(), live.planned().division_by_units(),
                            settings});
    if (!offer.is_better()) return {{}, offer.why()};
    if (!options.may_be_async) {
        return {{},
                "not " + offer.why() +
                    "; but its results depend on the cuts between devices, so it has to be "
                    "allowed (--async) or asked for (--plan async)"};
    }
    return {settings, offer.why()};
}

}  // namespace weft
