#include <cstdint>
#include <cstdio>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/scenes/generate.hpp"
#include "harness/scenes/hard_cases.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/free_memory.hpp"
#include "harness/support/nearest.hpp"
#include "harness/support/output_file.hpp"
#include "harness/support/text.hpp"

namespace carom {
namespace {

struct GenerateOptions {
    GeneratorArguments arguments;
    std::string hard_case;
    bool list_cases = false;
    bool json = false;
    std::string output;
};

void require_velocities(const GeneratorArguments& arguments) {
    if (!(arguments.least_velocity <= arguments.largest_velocity)) {
        throw InputError("VMAX: found " + number_text(arguments.largest_velocity) +
                         ", expected at least VMIN = " + number_text(arguments.least_velocity));
    }
    if (arguments.isotropic && arguments.least_velocity < 0) {
        throw InputError("VMIN: found " + number_text(arguments.least_velocity) +
                         ", expected a speed of at least 0 with --isotropic");
    }
}

/// The text of a scene is held as a whole before it is written.
void require_room_to_write(int discs) {
    constexpr std::int64_t bytes_per_line = 50; // at least: four numbers of most often 17 digits
    require_memory(discs * (static_cast<std::int64_t>(sizeof(Disc)) + bytes_per_line),
                   counted(discs, "disc") + " and their text");
}

Scene random_scene(const GeneratorArguments& arguments) {
    require_radius(arguments.radius, "R");
    require_side(arguments.side, arguments.radius, "L");
    require_velocities(arguments);
    require_room_to_write(arguments.count);
    return generate(arguments);
}

Scene scene_of_case(const std::string& name) {
    if (const HardCase* found = find_hard_case(name)) {
        return found->scene();
    }
    std::vector<std::string> names;
    for (const HardCase& one : hard_cases()) {
        names.emplace_back(one.name);
    }
    throw InputError("--case: found " + in_quotes(name) + ", expected a name from `carom generate --cases`" +
                     did_you_mean(name, names));
}

void print_cases(bool as_json) {
    auto list = nlohmann::ordered_json::array();
    for (const HardCase& one : hard_cases()) {
        list.push_back({{"name", one.name}, {"description", one.description}});
        if (!as_json) {
            std::printf("%-18s %s\n", std::string(one.name).c_str(), std::string(one.description).c_str());
        }
    }
    std::cout << (as_json ? list.dump(2) + "\n" : "");
}

void run_generate(const GenerateOptions& options) {
    if (options.list_cases) {
        print_cases(options.json);
    } else if (!options.hard_case.empty()) {
        write_text(options.output, scene_text(scene_of_case(options.hard_case)));
    } else {
        const Scene scene = random_scene(options.arguments);
        write_text(options.output, scene_text(scene));
        if (options.arguments.placement != Placement::overlapping) {
            std::fprintf(stderr, "carom: area fraction %.6f, no disc overlaps another\n",
                         area_fraction(scene));
        }
    }
}

/// What a random scene is made of. Returns N to VMAX, without which only a hard case can be written.
std::vector<CLI::Option*> add_scene_options(CLI::App& command, GeneratorArguments& scene) {
    const auto add = [&command](const char* name, auto& value, const CLI::Validator& right,
                                const char* help) {
        return command.add_option(name, value, help)->transform(right);
    };
    const auto velocity = number_from(-largest_number, largest_number);
    add_number(command, "--seed", scene.seed, 0, std::numeric_limits<std::uint64_t>::max(),
               "Seed of the 64-bit Mersenne Twister");
    add_choice<Placement>(command, "--placement", scene.placement,
                          {{"overlapping", Placement::overlapping},
                           {"random", Placement::random},
                           {"lattice", Placement::lattice}},
                          "overlapping: anywhere; random: one by one, none overlapping; lattice: jittered "
                          "hexagonal, none overlapping");
    command.add_flag("--isotropic", scene.isotropic,
                     "Directions uniform over the circle, speeds uniform in [VMIN, VMAX]");
    return {add("N", scene.count, number_from(0, most_discs), "Number of discs"),
            add("L", scene.side, finite_number(), "Side of the box"),
            add("R", scene.radius, finite_number(), "Radius of the discs"),
            add("STEPS", scene.steps, number_from(0, std::numeric_limits<int>::max()),
                "Units of time to simulate"),
            add("VMIN", scene.least_velocity, velocity, "Least velocity component"),
            add("VMAX", scene.largest_velocity, velocity, "Largest velocity component")};
}

} // namespace

void add_generate_command(CLI::App& program) {
    auto options = std::make_shared<GenerateOptions>();
    CLI::App* command = program.add_subcommand(
        "generate", "Write a random scene (uniform velocity components, or --isotropic), or a hard case");
    const auto arguments = add_scene_options(*command, options->arguments);
    const auto of_scenes =
        command->get_options([](const CLI::Option* one) { return one->get_name() != "--help"; });
    auto* hard_case = command->add_option("--case", options->hard_case, "Name of a hard case to write");
    auto* cases = command->add_flag("--cases", options->list_cases, "List the hard cases");
    command->add_flag("--json", options->json, "List them as JSON")->needs(cases);
    command->add_option("--output", options->output, "File to write instead of standard output")
        ->check(writable())
        ->excludes(cases);
    cases->excludes(hard_case);
    for (CLI::Option* option : of_scenes) {
        hard_case->excludes(option);
        cases->excludes(option);
    }
    command->callback([options, arguments] {
        for (const CLI::Option* argument : arguments) {
            if (argument->count() == 0 && options->hard_case.empty() && !options->list_cases) {
                throw InputError("found no " + argument->get_name() +
                                 ", expected N L R STEPS VMIN VMAX, or --case: `carom generate --help`");
            }
        }
        run_generate(*options);
    });
}

} // namespace carom
