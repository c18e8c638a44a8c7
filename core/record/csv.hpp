// Comma-separated values.
#pragma once
#include <string>

namespace tandem::core {

/// As RFC 4180 wants it in a cell: quoted where it holds a comma, a quote or the end of a line.
inline std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// The head of a column of numbers: "x_m", "speed_m_s", "charge".
inline std::string column_title(const std::string& name, const std::string& unit) {
  std::string title = name;
  if (unit.empty() || unit == "%") return title;
  title += '_';
  for (const char c : unit) title += c == '/' ? '_' : c;
  return title;
}

}  // namespace tandem::core
