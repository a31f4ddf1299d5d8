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

/// Those of this process whose names start with one of the prefixes, by name.
inline std::map<std::string, std::string>
variables_with_prefixes(std::initializer_list<std::string_view> prefixes) {
    std::map<std::string, std::string> found;
    for (const std::string& variable : own_environment()) {
        if (std::ranges::any_of(prefixes, [&](auto prefix) { return variable.starts_with(prefix); })) {
            const auto equals = variable.find('=');
            found.emplace(variable.substr(0, equals), variable.substr(equals + 1));
        }
    }
    return found;
}

} // namespace carom
