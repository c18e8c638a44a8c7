// Exceptions, texts, colours and bytes of the facade.
#include <algorithm>
#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/byte_array.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/string_utilities.h>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "hal/named_colors.hpp"

namespace argos {

CARGoSException::CARGoSException(const std::string& what, std::exception* nested) noexcept
    : m_strWhat(nested == nullptr ? what : what + "\n" + nested->what()) {}
CARGoSException::~CARGoSException() noexcept = default;
const char* CARGoSException::what() const noexcept {
  return m_strWhat.c_str();
}

// --- texts ---

void Tokenize(const std::string& text, std::vector<std::string>& tokens, const std::string& delimiters) {
  for (std::size_t at = text.find_first_not_of(delimiters); at != std::string::npos;) {
    const std::size_t end = text.find_first_of(delimiters, at);
    tokens.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(delimiters, end);
  }
}

std::string StringToUpperCase(const std::string& text) {
  std::string out = text;
  for (char& c : out) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return out;
}

std::string StringToLowerCase(const std::string& text) {
  std::string out = text;
  for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return out;
}

void Replace(std::string& text, const std::string& original, const std::string& replacement) {
  if (original.empty()) return;
  for (std::size_t at = text.find(original); at != std::string::npos; at = text.find(original, at + replacement.size()))
    text.replace(at, original.size(), replacement);
}

std::string& ExpandEnvVariables(std::string& text) {
  for (std::size_t at = text.find('$'); at != std::string::npos; at = text.find('$', at)) {
    std::size_t end = at + 1;
    while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) != 0 || text[end] == '_')) ++end;
    const std::string name = text.substr(at + 1, end - at - 1);
    const char* const value = std::getenv(name.c_str());
    if (value == nullptr) THROW_ARGOSEXCEPTION("the environment has no variable '" << name << "'")
    text.replace(at, end - at, value);
    at += std::strlen(value);
  }
  return text;
}

bool MatchPattern(const std::string& text, const std::string pattern) {
  std::size_t t = 0, p = 0, star = std::string::npos, from = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      from = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string::npos) {
      p = star + 1;
      t = ++from;
    } else {
      return false;
    }
  }
  return pattern.find_first_not_of('*', p) == std::string::npos;
}

// --- colours ---

namespace {

namespace hal = tandem::hal;

constexpr CColor color_of(hal::Rgb color) {
  return CColor(color.r, color.g, color.b);
}
constexpr CColor named(std::string_view name) {
  return color_of(hal::color_named(name).value());
}

}  // namespace

constinit CColor CColor::BLACK = named("black");
constinit CColor CColor::WHITE = named("white");
constinit CColor CColor::RED = named("red");
constinit CColor CColor::GREEN = named("green");
constinit CColor CColor::BLUE = named("blue");
constinit CColor CColor::MAGENTA = named("magenta");
constinit CColor CColor::CYAN = named("cyan");
constinit CColor CColor::YELLOW = named("yellow");
constinit CColor CColor::ORANGE = named("orange");
constinit CColor CColor::BROWN = named("brown");
constinit CColor CColor::PURPLE = named("purple");
constinit CColor CColor::GRAY10 = named("gray10");
constinit CColor CColor::GRAY20 = named("gray20");
constinit CColor CColor::GRAY30 = named("gray30");
constinit CColor CColor::GRAY40 = named("gray40");
constinit CColor CColor::GRAY50 = named("gray50");
constinit CColor CColor::GRAY60 = named("gray60");
constinit CColor CColor::GRAY70 = named("gray70");
constinit CColor CColor::GRAY80 = named("gray80");
constinit CColor CColor::GRAY90 = named("gray90");

void CColor::Set(const std::string& text) {
  if (const auto known = hal::color_named(text)) {
    *this = color_of(*known);
    return;
  }
  std::vector<std::string> parts;
  Tokenize(text, parts, ",");
  std::array<UInt8, 4> channels = {0, 0, 0, 255};
  bool good = parts.size() == 3 || parts.size() == 4;
  for (std::size_t i = 0; good && i < parts.size(); ++i) {
    char* end = nullptr;
    const long value = std::strtol(parts[i].c_str(), &end, 10);
    good = end != parts[i].c_str() && *end == '\0' && value >= 0 && value <= 255;
    if (good) channels[i] = static_cast<UInt8>(value);
  }
  if (!good) THROW_ARGOSEXCEPTION("'" << text << "' is no colour: it is a name such as 'red', or 'r,g,b,a' of 0 to 255")
  *this = CColor(channels[0], channels[1], channels[2], channels[3]);
}

CColor CColor::Blend(const CColor& background) const noexcept {
  const Real opacity = m_unAlpha / 255.0;
  const auto mixed = [&](UInt8 over, UInt8 under) {
    return static_cast<UInt8>(opacity * over + (1.0 - opacity) * under);
  };
  return CColor(mixed(m_unRed, background.m_unRed), mixed(m_unGreen, background.m_unGreen),
                mixed(m_unBlue, background.m_unBlue));
}

std::ostream& operator<<(std::ostream& out, const CColor& color) {
  for (const hal::NamedColor& known : hal::kNamedColors) {
    if (color == color_of(known.color)) return out << known.name;
  }
  return out << color.m_unRed << "," << color.m_unGreen << "," << color.m_unBlue << "," << color.m_unAlpha;
}

std::istream& operator>>(std::istream& in, CColor& color) {
  std::string text;
  if (in >> text) color.Set(text);
  return in;
}

// --- bytes ---

CByteArray& CByteArray::Append(UInt64 value, size_t size) {
  for (size_t i = size; i > 0; --i) m_vecBuffer.push_back(static_cast<UInt8>(value >> (8 * (i - 1))));
  return *this;
}

UInt64 CByteArray::Fetch(size_t size) {
  std::array<UInt8, 8> bytes{};
  FetchBuffer(bytes.data(), size);
  UInt64 value = 0;
  for (size_t i = 0; i < size; ++i) value = value << 8 | bytes[i];
  return value;
}

CByteArray& CByteArray::AddBuffer(const UInt8* bytes, size_t size) {
  m_vecBuffer.insert(m_vecBuffer.end(), bytes, bytes + size);
  return *this;
}

CByteArray& CByteArray::FetchBuffer(UInt8* bytes, size_t size) {
  if (size > Size()) THROW_ARGOSEXCEPTION("a CByteArray of " << Size() << " bytes has no " << size << " to take")
  std::copy_n(m_vecBuffer.begin(), size, bytes);
  m_vecBuffer.erase(m_vecBuffer.begin(), m_vecBuffer.begin() + static_cast<std::ptrdiff_t>(size));
  return *this;
}

CByteArray* CByteArray::operator()(size_t start, ssize_t end) const {
  const size_t last = end < 0 ? Size() : static_cast<size_t>(end);
  if (start > last || last > Size())
    THROW_ARGOSEXCEPTION("a CByteArray of " << Size() << " bytes has no bytes " << start << " to " << last)
  return new CByteArray(m_vecBuffer.data() + start, last - start);
}

namespace {
constexpr SInt32 kNotFinite = std::numeric_limits<SInt32>::max();  // exponent: the mantissa is the sign; 0: no number
}  // namespace

CByteArray& CByteArray::operator<<(double value) {
  if (!std::isfinite(value)) return *this << SInt64{std::isnan(value) ? 0 : value > 0.0 ? 1 : -1} << kNotFinite;
  SInt32 exponent = 0;
  const auto mantissa = static_cast<SInt64>(std::ldexp(std::frexp(value, &exponent), 62));
  return *this << mantissa << exponent;
}

CByteArray& CByteArray::operator>>(double& value) {
  SInt64 mantissa = 0;
  SInt32 exponent = 0;
  *this >> mantissa >> exponent;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  value = exponent != kNotFinite ? std::ldexp(static_cast<double>(mantissa), exponent - 62)
                                 : static_cast<double>(mantissa) * kInfinity;  // 0 * infinity is no number
  return *this;
}

CByteArray& CByteArray::operator<<(float value) {
  return *this << static_cast<double>(value);
}

CByteArray& CByteArray::operator>>(float& value) {
  double wide = 0.0;
  *this >> wide;
  value = static_cast<float>(wide);
  return *this;
}

CByteArray& CByteArray::operator<<(const std::string& value) {
  return AddBuffer(reinterpret_cast<const UInt8*>(value.c_str()), value.size() + 1);
}

CByteArray& CByteArray::operator>>(std::string& value) {
  const auto end = std::find(m_vecBuffer.begin(), m_vecBuffer.end(), UInt8{0});
  if (end == m_vecBuffer.end()) THROW_ARGOSEXCEPTION("a CByteArray holds no text: there is no zero at its end")
  value.assign(m_vecBuffer.begin(), end);
  m_vecBuffer.erase(m_vecBuffer.begin(), end + 1);
  return *this;
}

std::ostream& operator<<(std::ostream& out, const CByteArray& bytes) {
  out << "CByteArray {";
  for (size_t i = 0; i < bytes.Size(); ++i) out << (i == 0 ? "" : ", ") << static_cast<unsigned>(bytes[i]);
  return out << "}";
}

}  // namespace argos
