#include "apps/weft/command_line/parse_error.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runtime/near_miss.h"

namespace weft {
namespace {

/// The subcommand that the user has chosen, or weft itself.
const CLI::App& chosen_command(const CLI::App& app) {
    const std::vector<CLI::App*> chosen = app.get_subcommands();
    return chosen.empty() ? app : chosen_command(*chosen.front());
}

std::vector<std::string> option_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    return names;
}

std::vector<std::string> command_names(const CLI::App& app) {
    std::vector<std::string> names;
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
        names.push_back(command->get_name());
    }
    return names;
}

std::string command_path(const CLI::App& app, const CLI::App& command) {
    if (&app == &command) return app.get_name();
    return command_path(app, *command.get_parent()) + " " + command.get_name();
}

/// For a word that nothing expects: what it may have been meant to be.
std::string describe_stray_word(const CLI::App& app, const CLI::App& command,
                                const std::string& word) {
    const std::string help = fmt::format("see '{} --help'", command_path(app, command));
    if (word.starts_with("-")) {
        const std::string name = word.substr(0, word.find('='));
        const std::string near = near_miss(name, option_names(command));
        return fmt::format("unknown option '{}'; {}", name, near.empty() ? help : near);
    }
    if (&app == &command) {
        return fmt::format("unknown command '{}'; {}", word,
                           near_miss_or_list(word, command_names(app)));
    }
    return fmt::format("unexpected argument '{}'; {}", word, help);
}

std::string one_line(std::string text) {
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return text;
}

/// Of "Could not convert: NAME = VALUE". Values of options are checked before; this is for flags.
std::string describe_conversion(const CLI::App& command, const std::string& text) {
    const std::size_t begin = text.find("--"), equals = text.find(" = ");
    if (begin == std::string::npos || equals == std::string::npos || equals < begin) return text;
    const std::string name = text.substr(begin, equals - begin);
    const CLI::Option* option = command.get_option_no_throw(name);
    const bool is_flag = option != nullptr && option->get_expected_min() == 0;
    return fmt::format("{}: '{}': expected {}", name, text.substr(equals + 3),
                       is_flag ? "no value" : "another kind of value");
}

}  // namespace

std::string describe_parse_error(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::App& command = chosen_command(app);
    const std::vector<std::string> stray = command.remaining();
    if (!stray.empty()) return describe_stray_word(app, command, stray.front());
    if (&app == &command) {
        return fmt::format("a command is missing; known: {}", fmt::join(command_names(app), ", "));
    }
    std::string what = one_line(error.what());
    if (error.get_name() == "ConversionError") what = describe_conversion(command, what);
    return fmt::format("{}; see '{} --help'", what, command_path(app, command));
}

}  // namespace weft
