#pragma once

#include <string>

namespace carom {

/// The script with which a shell, `bash` or `zsh`, completes a command line of this program. It reads what
/// can follow from the help of the verb at hand, so that both always agree.
std::string completion(const std::string& shell);

} // namespace carom
