// Reads foreign JSON: a value that is missing, or of another kind, is `otherwise`.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "hal/json/json.hpp"

namespace tandem::hal {

/// The member of that name; null where `json` is no object, or has none. As long as `json`.
const Json* member_of(const Json& json, const char* key);

std::string text_of(const Json& json, const char* key, std::string_view otherwise = {});
/// A finite number.
double number_of(const Json& json, const char* key, double otherwise = 0.0);
std::int64_t whole_of(const Json& json, const char* key, std::int64_t otherwise = 0);
/// A whole number that is not negative.
std::uint64_t count_of(const Json& json, const char* key, std::uint64_t otherwise = 0);
/// Whether the member is there, and is true.
bool flag_of(const Json& json, const char* key);
/// An array, or an object; an empty one where there is none. As long as `json`.
const Json& list_of(const Json& json, const char* key);
const Json& object_of(const Json& json, const char* key);
/// The texts of an array; an element that is none is empty.
std::vector<std::string> texts_of(const Json& json, const char* key);
/// The finite number at `index` of an array.
double item_of(const Json& list, std::size_t index, double otherwise = 0.0);

}  // namespace tandem::hal
