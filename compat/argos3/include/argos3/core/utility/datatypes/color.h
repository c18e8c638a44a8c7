// Colours.
#ifndef TANDEM_ARGOS3_COLOR_H
#define TANDEM_ARGOS3_COLOR_H
#include <iostream>
#include <string>

#include <argos3/core/utility/datatypes/datatypes.h>
#include <argos3/core/utility/string_utilities.h>

namespace argos {

/// Red, green, blue and opacity, 0 to 255. In text a name, or "r,g,b,a".
class CColor {
 public:
  static CColor BLACK, WHITE, RED, GREEN, BLUE, MAGENTA, CYAN, YELLOW, ORANGE, BROWN, PURPLE;
  static CColor GRAY10, GRAY20, GRAY30, GRAY40, GRAY50, GRAY60, GRAY70, GRAY80, GRAY90;

  constexpr CColor() noexcept : m_unRed(0), m_unGreen(0), m_unBlue(0), m_unAlpha(255) {}
  constexpr explicit CColor(UInt8 red, UInt8 green, UInt8 blue, UInt8 alpha = 255) noexcept
      : m_unRed(red), m_unGreen(green), m_unBlue(blue), m_unAlpha(alpha) {}

  Real ToGrayScale() const noexcept { return 0.299 * m_unRed + 0.587 * m_unGreen + 0.114 * m_unBlue; }
  UInt8 GetRed() const noexcept { return m_unRed; }
  UInt8 GetGreen() const noexcept { return m_unGreen; }
  UInt8 GetBlue() const noexcept { return m_unBlue; }
  UInt8 GetAlpha() const noexcept { return m_unAlpha; }
  void SetRed(UInt8 red) noexcept { m_unRed = red; }
  void SetGreen(UInt8 green) noexcept { m_unGreen = green; }
  void SetBlue(UInt8 blue) noexcept { m_unBlue = blue; }
  void SetAlpha(UInt8 alpha) noexcept { m_unAlpha = alpha; }
  void Set(UInt8 red, UInt8 green, UInt8 blue, UInt8 alpha = 255) noexcept { *this = CColor(red, green, blue, alpha); }
  /// @throws CARGoSException for a text that is no colour
  void Set(const std::string& text);
  /// It over an opaque background.
  CColor Blend(const CColor& background) const noexcept;

  /// Red in the lowest byte.
  operator UInt32() const {
    return static_cast<UInt32>(m_unRed) | static_cast<UInt32>(m_unGreen) << 8 | static_cast<UInt32>(m_unBlue) << 16 |
           static_cast<UInt32>(m_unAlpha) << 24;
  }
  bool operator==(const CColor& c) const noexcept {
    return m_unRed == c.m_unRed && m_unGreen == c.m_unGreen && m_unBlue == c.m_unBlue && m_unAlpha == c.m_unAlpha;
  }
  bool operator!=(const CColor& c) const noexcept { return !(*this == c); }
  bool operator<(const CColor& c) const noexcept { return static_cast<UInt32>(*this) < static_cast<UInt32>(c); }

  friend std::ostream& operator<<(std::ostream& out, const CColor& color);
  friend std::istream& operator>>(std::istream& in, CColor& color);

 private:
  UInt8 m_unRed, m_unGreen, m_unBlue, m_unAlpha;
};

std::ostream& operator<<(std::ostream& out, const CColor& color);
std::istream& operator>>(std::istream& in, CColor& color);

}  // namespace argos

#endif
