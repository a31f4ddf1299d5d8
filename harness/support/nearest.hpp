#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace carom {

/// The name that takes the fewest letters to insert, delete or replace (Levenshtein's distance); there must
/// be one at least.
std::string nearest(std::string_view found, const std::vector<std::string>& names);

/// "; did you mean 'published'?" if a name is so near that it may have been meant, else nothing.
std::string did_you_mean(std::string_view found, const std::vector<std::string>& names);

} // namespace carom
