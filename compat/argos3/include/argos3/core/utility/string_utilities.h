// Text to values and back.
#ifndef TANDEM_ARGOS3_STRING_UTILITIES_H
#define TANDEM_ARGOS3_STRING_UTILITIES_H
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

/// As `>>` reads it; T() where the text is none.
template <typename T>
T FromString(const std::string& text) {
  std::istringstream in(text);
  T value = T();
  in >> std::boolalpha >> value;
  return value;
}

/// Reads exactly `count` fields between delimiters.
template <typename T>
void ParseValues(std::istream& in, UInt32 count, T* values, const char delimiter = '\n') {
  for (UInt32 i = 0; i < count; ++i) {
    std::string field;
    if (!std::getline(in, field, delimiter))
      THROW_ARGOSEXCEPTION("Parse error: expected " << count << " values between '" << delimiter << "', found " << i);
    std::istringstream one(field);
    one >> values[i];
  }
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
