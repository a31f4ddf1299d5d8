#pragma once

#include <algorithm>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <unistd.h>

namespace carom {

/// NAME=VALUE, all that this process sees.
inline std::vector<std::string> own_environment() {
    std::vector<std::string> variables;
    for (char** variable = environ; *variable != nullptr; ++variable) {
        variables.emplace_back(*variable);
    }
    return variables;
}

/// Those of an environment whose names start with one of the prefixes, by name.
inline std::map<std::string, std::string>
variables_with_prefixes(const std::vector<std::string>& environment,
                        std::initializer_list<std::string_view> prefixes) {
    std::map<std::string, std::string> found;
    for (const std::string& variable : environment) {
        const auto equals = variable.find('=');
        const bool is_wanted =
            std::ranges::any_of(prefixes, [&](auto prefix) { return variable.starts_with(prefix); });
        if (is_wanted && equals != std::string::npos) {
            found.emplace(variable.substr(0, equals), variable.substr(equals + 1));
        }
    }
    return found;
}

} // namespace carom
