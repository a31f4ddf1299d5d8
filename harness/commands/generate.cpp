#include "harness/scenes/generate.hpp"

#include <cstdio>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "harness/commands/commands.hpp"
#include "harness/scenes/hard_cases.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
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

Scene random_scene(const GeneratorArguments& arguments) {
    require_radius(arguments.radius, "R");
    require_side(arguments.side, arguments.radius, "L");
    require_velocities(arguments);
    return generate(arguments);
}

Scene scene_of_case(const std::string& name) {
    if (const HardCase* found = find_hard_case(name)) {
        return found->scene();
    }
    throw InputError("--case: found '" + name + "', expected a name from `carom generate --cases`");
}

void print_cases(bool json) {
    if (json) {
        auto list = nlohmann::ordered_json::array();
        for (const HardCase& one : hard_cases()) {
            list.push_back({{"name", one.name}, {"description", one.description}});
        }
        std::cout << list.dump(2) << '\n';
        return;
    }
    for (const HardCase& one : hard_cases()) {
        std::printf("%-18s %s\n", std::string(one.name).c_str(), std::string(one.description).c_str());
    }
}

void write_scene(const Scene& scene, const std::string& output) {
    const std::string text = scene_text(scene);
    if (output.empty()) {
        std::cout << text;
        return;
    }
    OutputFile file(output);
    file.write(text);
    file.finish();
}

void run_generate(const GenerateOptions& options) {
    if (options.list_cases) {
        print_cases(options.json);
    } else if (!options.hard_case.empty()) {
        write_scene(scene_of_case(options.hard_case), options.output);
    } else {
        const Scene scene = random_scene(options.arguments);
        write_scene(scene, options.output);
        if (options.arguments.placement != Placement::overlapping) {
            std::fprintf(stderr, "carom: area fraction %.6f, no disc overlaps another\n",
                         area_fraction(scene));
        }
    }
}

/// N to VMAX, without which only a hard case can be written.
std::vector<CLI::Option*> add_arguments(CLI::App& command, GeneratorArguments& arguments) {
    const CLI::Range speeds(-largest_number, largest_number);
    return {
        command.add_option("N", arguments.count, "Number of discs")->check(CLI::Range(0, most_discs)),
        command.add_option("L", arguments.side, "Side of the box"),
        command.add_option("R", arguments.radius, "Radius of the discs"),
        command.add_option("STEPS", arguments.steps, "Units of time to simulate")
            ->check(CLI::Range(0, std::numeric_limits<int>::max())),
        command.add_option("VMIN", arguments.least_velocity, "Least velocity component")->check(speeds),
        command.add_option("VMAX", arguments.largest_velocity, "Largest velocity component")->check(speeds)};
}

std::vector<CLI::Option*> add_choices(CLI::App& command, GeneratorArguments& arguments) {
    const std::map<std::string, Placement> placements{{"overlapping", Placement::overlapping},
                                                      {"random", Placement::random},
                                                      {"lattice", Placement::lattice}};
    return {command.add_option("--seed", arguments.seed, "Seed of the 64-bit Mersenne Twister")
                ->check(CLI::NonNegativeNumber)
                ->capture_default_str(),
            command
                .add_option("--placement", arguments.placement,
                            "overlapping: anywhere; random: one by one, none overlapping; lattice: jittered "
                            "hexagonal, none overlapping")
                ->transform(CLI::CheckedTransformer(placements).description(""))
                ->default_str("overlapping"),
            command.add_flag("--isotropic", arguments.isotropic,
                             "Directions uniform over the circle, speeds uniform in [VMIN, VMAX]")};
}

} // namespace

void add_generate_command(CLI::App& program) {
    auto options = std::make_shared<GenerateOptions>();
    CLI::App* command = program.add_subcommand(
        "generate", "Write a random scene (uniform velocity components, or --isotropic), or a hard case");
    const auto arguments = add_arguments(*command, options->arguments);
    const auto choices = add_choices(*command, options->arguments);
    auto* hard_case = command->add_option("--case", options->hard_case, "Name of a hard case to write");
    auto* cases = command->add_flag("--cases", options->list_cases, "List the hard cases");
    command->add_flag("--json", options->json, "List them as JSON")->needs(cases);
    command->add_option("--output", options->output, "File to write instead of standard output")
        ->excludes(cases);
    cases->excludes(hard_case);
    for (const auto& group : {arguments, choices}) {
        for (CLI::Option* option : group) {
            hard_case->excludes(option);
            cases->excludes(option);
        }
    }
    command->callback([options, arguments] {
        for (const CLI::Option* argument : arguments) {
            if (argument->count() == 0 && options->hard_case.empty() && !options->list_cases) {
                throw CLI::RequiredError(argument->get_name());
            }
        }
        run_generate(*options);
    });
}

} // namespace carom
