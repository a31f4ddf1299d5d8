#include <iostream>
#include <memory>

#include "harness/commands/commands.hpp"
#include "harness/doctor/doctor.hpp"

namespace carom {

void add_doctor_command(CLI::App& program) {
    auto json = std::make_shared<bool>(false);
    auto build = std::make_shared<bool>(false);
    CLI::App* command = program.add_subcommand(
        "doctor", "Tell what this machine can and cannot measure, and why; changes nothing");
    command->add_flag("--json", *json, "Print the findings as one JSON object");
    command->add_flag("--build", *build, "Print only how this program was built, as one JSON object");
    command->callback([json, build] {
        if (*build) {
            std::cout << build_json().dump(2) << '\n';
            return;
        }
        constexpr double noise_seconds = 2;
        const auto findings = doctor_json(noise_seconds);
        std::cout << (*json ? findings.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                                  "\n"
                            : doctor_text(findings));
    });
}

} // namespace carom
