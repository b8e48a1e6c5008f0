// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace orrery::film {

/// The 32-bit x86 variant of MurmurHash3.
///
/// Reference  appleby2011
std::uint32_t murmur3(const std::string& text, std::uint32_t seed = 0);

/// The Cryptomatte id of a name: the bits of a float that is neither zero, subnormal, infinite nor NaN.
///
/// Reference  cryptomatte-1.2, section "Hashing"
std::uint32_t matte_id(const std::string& name);

/// An id as eight lower-case hexadecimal digits: "13851a76".
std::string matte_id_text(std::uint32_t id);

}  // namespace orrery::film
