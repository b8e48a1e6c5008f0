// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace orrery::film {

/// MurmurHash3, 32 bits, x86.
///
/// Reference  appleby2011
std::uint32_t murmur3(const std::string& text, std::uint32_t seed = 0);

/// What stands in a Cryptomatte's channels for a name, as the bits of a float that is neither infinite, nor no number,
/// nor so small that some machine takes it for 0.
///
/// Reference  cryptomatte-1.2, section "Hashing"
std::uint32_t matte_id(const std::string& name);

/// Eight lower-case digits: "13851a76".
std::string matte_id_text(std::uint32_t id);

}  // namespace orrery::film
