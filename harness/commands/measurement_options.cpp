#include "harness/commands/measurement_options.hpp"

#include <filesystem>

#include "harness/command_line/values.hpp"
#include "harness/records/record.hpp"
#include "harness/scenes/scene_file.hpp"
#include "harness/support/errors.hpp"
#include "harness/support/input_file.hpp"
#include "harness/support/process_clock.hpp"
#include "harness/support/sha256.hpp"

namespace carom {

void add_scene_option(CLI::App& command, std::string& scene) {
    command.add_option("SCENE", scene, "Scene file; - is standard input")->required();
}

void add_record_options(CLI::App& command, std::string& record, std::vector<std::string>& tags) {
    command.add_option("--record", record, "File for the record of this process")->check(writable());
    command.add_option("--tag", tags, "KEY=VALUE to keep in the record; may be repeated")
        ->allow_extra_args(false)
        ->check(CLI::Validator(
            [](const std::string& tag) {
                tags_json({tag});
                return std::string();
            },
            ""));
}

void add_measurement_options(CLI::App& command, MeasurementOptions& options) {
    add_record_options(command, options.record, options.tags);
    command.get_option("--record")->description("File for the record of this process (one case only)");
    add_number(command, "--warm-up", options.warm_ups, 0, 1000,
               "Untimed whole runs before the first timed one; with none, two steps");
    add_choice<CheckScope>(command, "--check", options.scope,
                           {{word(CheckScope::last_step), CheckScope::last_step},
                            {word(CheckScope::every_step), CheckScope::every_step}},
                           "What is verified: last-step of each run, or every-step of one before");
}

LoadedScene load_scene(const std::string& path) {
    const std::string text = read_file(path);
    const std::string shown = shown_name(path);
    const double start = process_seconds();
    LoadedScene loaded{.scene = parse_scene(text, shown),
                       .name = std::filesystem::path(shown).filename().string(),
                       .sha256 = {},
                       .parse_seconds = 0};
    loaded.parse_seconds = process_seconds() - start;
    loaded.sha256 = sha256(text);
    if (loaded.scene.steps == 0) {
        throw InputError(shown + ":4: found 0 steps, expected at least one to time");
    }
    return loaded;
}

Measurement measurement_of(const LoadedScene& loaded, const Variant& variant, const Tuning& tuning,
                           const MeasurementOptions& options, const std::string& library) {
    return {.scene = loaded.scene,
            .scene_name = loaded.name,
            .scene_sha256 = loaded.sha256,
            .variant = variant,
            .library = library,
            .tuning = tuning,
            .scope = options.scope,
            .warm_ups = options.warm_ups,
            .parse_seconds = loaded.parse_seconds,
            .tags = options.tags};
}

} // namespace carom
