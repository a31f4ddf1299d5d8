#include <iostream>
#include <memory>

#include "harness/commands/commands.hpp"
#include "harness/doctor/findings.hpp"
#include "harness/machine/provenance.hpp"
#include "harness/support/json.hpp"

namespace carom {

void add_doctor_command(CLI::App& program) {
    auto json = std::make_shared<bool>(false);
    auto noise = std::make_shared<bool>(false);
    auto build = std::make_shared<bool>(false);
    CLI::App* command =
        program.add_subcommand("doctor", "Tell what this machine can and cannot measure, and why. It changes "
                                         "nothing");
    command->add_flag("--json", *json, "Print the findings as one JSON object");
    command->add_flag("--noise", *noise,
                      "Watch equal work for 20 s, and draw how much neighbouring stretches of time differ");
    command->add_flag("--build", *build, "Print only how this program was built, as one JSON object");
    command->callback([json, noise, build] {
        if (*build) {
            auto built = build_json();
            built["openmp"] = {{"runtime", openmp_json()["runtime"]}};
            std::cout << json_text(built, 2) << '\n';
            return;
        }
        if (*noise) {
            constexpr double seconds = 20;
            std::cout << noise_figure(measure_noise(seconds));
            return;
        }
        constexpr double noise_seconds = 2;
        const auto findings = examine_machine(noise_seconds);
        std::cout << (*json ? json_text(findings, 2) + "\n" : doctor_text(findings));
    });
}

} // namespace carom
