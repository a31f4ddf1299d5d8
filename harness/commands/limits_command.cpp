#include <cstdint>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "harness/command_line/values.hpp"
#include "harness/commands/commands.hpp"
#include "harness/commands/measurement_options.hpp"
#include "harness/machine/limits.hpp"
#include "harness/machine/machine.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/machine/suspensions.hpp"
#include "harness/machine/threads.hpp"
#include "harness/records/record.hpp"
#include "harness/support/json.hpp"

namespace carom {
namespace {

constexpr std::int64_t mebibyte = 1 << 20;

struct LimitsOptions {
    int threads = default_threads();
    double seconds = 0.1;
    std::optional<std::int64_t> memory_mebibytes;
    bool json = false;
    std::string record;
    std::vector<std::string> tags;
};

void limits(const LimitsOptions& options) {
    const std::int64_t most_bytes = options.memory_mebibytes
                                        ? *options.memory_mebibytes * mebibyte
                                        : read_machine()["memory_bytes"].get<std::int64_t>() / 4;
    Suspensions suspensions;
    suspensions.start();
    const auto found = measure_limits(options.threads, options.seconds, most_bytes);
    suspensions.require_none("limits");
    std::cout << (options.json ? json_text(found, 2) + "\n" : limits_text(found));
    if (!options.record.empty()) {
        const nlohmann::ordered_json one{{"tags", tags_json(options.tags)}, {"limits", found}};
        write_record(options.record, "limits", nlohmann::ordered_json::array({one}), options.threads);
    }
}

} // namespace

void add_limits_command(CLI::App& program) {
    auto options = std::make_shared<LimitsOptions>();
    CLI::App* command = program.add_subcommand(
        "limits",
        "Measure what this machine can do at most: copy bandwidth and arithmetic, on 1 to T threads");
    add_number(*command, "--threads", options->threads, 1, most_threads,
               "The greatest number of OpenMP threads");
    add_number(*command, "--seconds", options->seconds, 0.0, 60.0, "About how long each rate is measured");
    command
        ->add_option("--memory", options->memory_mebibytes,
                     "The most that a copy may take, in MiB; by itself a quarter of the machine's memory")
        ->transform(number_from(1, 1 << 30))
        ->type_name("N");
    command->add_flag("--json", options->json, "Print the rates as one JSON object");
    add_record_options(*command, options->record, options->tags);
    command->get_option("--record")->description("File for the record of the rates");
    command->callback([options] { limits(*options); });
}

} // namespace carom
