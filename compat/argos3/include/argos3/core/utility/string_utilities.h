// Text to values and back.
#ifndef TANDEM_ARGOS3_STRING_UTILITIES_H
#define TANDEM_ARGOS3_STRING_UTILITIES_H
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

/// As `<<` writes it; booleans as words.
template <typename T>
std::string ToString(const T& value) {
  std::ostringstream out;
  out << std::boolalpha << value;
  return out.str();
}

namespace tandem_detail {

/// A byte of a number. @throws CARGoSException when it is not in the range of the type
template <typename Byte>
Byte ToByte(SInt32 number) {
  if (number < std::numeric_limits<Byte>::min() || number > std::numeric_limits<Byte>::max())
    THROW_ARGOSEXCEPTION(number << " is not in the range of a byte, " << +std::numeric_limits<Byte>::min() << " to "
                                << +std::numeric_limits<Byte>::max())
  return static_cast<Byte>(number);
}

// Bytes are numbers, not characters. False: the text is none.
template <typename T>
bool Read(std::istream& in, T& value) {
  return static_cast<bool>(in >> std::boolalpha >> value);
}
template <typename Byte>
bool ReadByte(std::istream& in, Byte& value) {
  SInt32 number = 0;
  if (!(in >> number)) return false;
  value = ToByte<Byte>(number);
  return true;
}
inline bool Read(std::istream& in, UInt8& value) {
  return ReadByte(in, value);
}
inline bool Read(std::istream& in, SInt8& value) {
  return ReadByte(in, value);
}

}  // namespace tandem_detail

/// As `>>` reads it; T() where the text is none.
template <typename T>
T FromString(const std::string& text) {
  std::istringstream in(text);
  T value = T();
  tandem_detail::Read(in, value);
  return value;
}

/// Reads exactly `count` fields between delimiters. @throws CARGoSException when there are fewer or more, or one is no
/// such value
template <typename T>
void ParseValues(std::istream& in, UInt32 count, T* values, const char delimiter = '\n') {
  for (UInt32 i = 0; i < count; ++i) {
    std::string field;
    if (!std::getline(in, field, delimiter))
      THROW_ARGOSEXCEPTION("Parse error: expected " << count << " values between '" << delimiter << "', found " << i);
    std::istringstream one(field);
    T value = T();
    if (!tandem_detail::Read(one, value))
      THROW_ARGOSEXCEPTION("Parse error: '" << field << "' is no such value as is expected");
    values[i] = value;
  }
  if (in.peek() != std::istream::traits_type::eof())
    THROW_ARGOSEXCEPTION("Parse error: expected " << count << " values between '" << delimiter << "', found more");
  in.clear();
}

template <typename T>
void ParseValues(const std::string& text, const UInt32 count, T* values, const char delimiter = '\n') {
  std::istringstream in(text);
  ParseValues<T>(in, count, values, delimiter);
}

/// Appends the parts of `text` between any of the delimiters; empty parts are left out.
void Tokenize(const std::string& text, std::vector<std::string>& tokens, const std::string& delimiters = " ");
std::string StringToUpperCase(const std::string& text);
std::string StringToLowerCase(const std::string& text);
void Replace(std::string& text, const std::string& original, const std::string& replacement);
std::string& ExpandEnvVariables(std::string& text);
/// Whether `text` fits a pattern with `*` and `?`.
bool MatchPattern(const std::string& text, const std::string pattern);

}  // namespace argos

#endif
