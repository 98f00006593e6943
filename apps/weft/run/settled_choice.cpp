#include "apps/weft/run/settled_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <iostream>

#include "runtime/error.h"
#include "simulation/output/any_checkpoint.h"
#include "simulation/scene/method.h"

namespace weft {
namespace {

std::string named(const TextPairs& pairs, const std::string& name) {
    const auto found = std::ranges::find(pairs, name, &TextPairs::value_type::first);
    if (found == pairs.end()) throw UserError("the checkpoint does not say: " + name);
    return found->second;
}

SolverChoice recorded_choice(const TextPairs& settings) {
    const auto number = [&](const char* name) {
        try {
            return std::stoi(named(settings, name));
        } catch (const std::logic_error&) {
            throw UserError(std::string("the checkpoint is damaged: ") + name +
                            " is no number; --force starts the run anew");
        }
    };
    return {method_named(named(settings, "method")), number("iterations"), number("substeps"),
            named(settings, "solver_choice")};
}

}  // namespace

SolverChoice settled_choice(const Scene& scene, const RunOptions& options,
                            const std::filesystem::path& checkpoint) {
    if (options.resume && std::filesystem::exists(checkpoint)) {
        // Whether it is of this run, is seen when it goes on.
        return recorded_choice(settings_of(read_any_checkpoint(checkpoint), checkpoint));
    }
    if (!options.quiet) {
        std::cerr << fmt::format("weft: {}: measuring which solver serves best\n", scene.name)
                  << std::flush;
    }
    return choose_solver(scene, options.simulation().plan);
}

}  // namespace weft
