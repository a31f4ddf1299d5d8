#include "harness/command_line/values.hpp"

namespace carom {

std::string alternatives(const std::vector<std::string>& words) {
    std::string text = words.front();
    for (std::size_t k = 1; k < words.size(); ++k) {
        text += "|" + words[k];
    }
    return text;
}

CLI::Validator one_of(const std::vector<std::string>& words) {
    std::string expected = words.front();
    for (std::size_t k = 1; k < words.size(); ++k) {
        expected += (k + 1 < words.size() ? ", " : " or ") + words[k];
    }
    const auto check = [words, expected](std::string& word) {
        return std::ranges::find(words, word) != words.end()
                   ? std::string()
                   : "found " + in_quotes(word) + ", expected " + expected;
    };
    return {check, ""};
}

} // namespace carom
