#pragma once
// Help for a name that is not known: what was probably meant, and what there is.

#include <span>
#include <string>
#include <string_view>

namespace petrichor {

// The known name that `wanted` is probably a slip of (case, a few letters, or a part of it), or "".
std::string_view nearest_name(std::string_view wanted, std::span<const std::string_view> known);

// The end of a message: `; did you mean "spot"? Known: point, spot, directional`, the question only
// where a name is near.
std::string name_hint(std::string_view wanted, std::span<const std::string_view> known);

}  // namespace petrichor
