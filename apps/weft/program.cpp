#include "apps/weft/program.h"

#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>

#include <CLI/CLI.hpp>

#include "apps/weft/command_line/parse_error.h"
#include "apps/weft/command_line/typed_line.h"
#include "apps/weft/commands/commands.h"
#include "apps/weft/run/interrupt.h"
#include "runtime/error.h"

namespace weft {

namespace {

constexpr int kRunFailed = 1;
constexpr int kWrongRequest = 2;
constexpr int kSignalled = 128;  // + the signal's number, as shells count

void add_commands(CLI::App& app) {
    add_run_command(app);
    add_batch_command(app);
    add_error_command(app);
    add_stability_command(app);
    add_inspect_command(app);
    add_compare_command(app);
    add_devices_command(app);
    add_plan_command(app);
    add_replay_command(app);
    add_trace_command(app);
}

int fail(int exit_code, const std::string& message) {
    std::cerr << "weft: error: " << message << std::endl;
    return exit_code;
}

/// The exit code of a command that has done what it was asked to.
int end_of_output() {
    if (std::cout.flush()) return EXIT_SUCCESS;
    return fail(kRunFailed, "standard output cannot be written");
}

int run(CLI::App& app, int argc, char** argv) {
    try {
        app.parse(argc, argv);
        return end_of_output();
    } catch (const CLI::ParseError& error) {
        // Help, version and the like come as errors of code 0, and print themselves.
        if (error.get_exit_code() == 0) {
            app.exit(error);
            return end_of_output();
        }
        return fail(kWrongRequest, describe_parse_error(app, error));
    } catch (const UserError& error) {
        return fail(kWrongRequest, error.what());
    } catch (const Interrupted& stop) {
        std::cerr << "weft: " << stop.what() << std::endl;
        return kSignalled + stop.signal();
    } catch (const EndedEarly& end) {
        std::cerr << "weft: " << end.what() << std::endl;
        return end.exit_code();
    } catch (const RunError& error) {
        return fail(kRunFailed, error.what());
    } catch (const std::bad_alloc&) {
        return fail(kRunFailed, "out of memory; use a smaller scene.size, or more memory");
    } catch (const std::exception& error) {
        return fail(kRunFailed, error.what());
    } catch (...) {
        return fail(kRunFailed, "unknown exception");
    }
}

}  // namespace

int run_program(int argc, char** argv) {
    note_command_line(argc, argv);
    CLI::App app{"Simulates cloth on every device of this machine, alone and together", "weft"};
    app.set_version_flag("--version", "weft " WEFT_VERSION);
    app.set_help_flag("-h,--help", "print this help");
    app.require_subcommand(1);
    app.footer(
        "Example:\n  weft run scenes/tablecloth.toml --frames 20\n"
        "'weft COMMAND --help' describes a command.");
    add_commands(app);
    return run(app, argc, argv);
}

}  // namespace weft
