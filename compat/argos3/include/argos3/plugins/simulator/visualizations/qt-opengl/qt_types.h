// The types of Qt that user functions have in their signatures: keys, colours, texts on the window.
#ifndef TANDEM_ARGOS3_QT_TYPES_H
#define TANDEM_ARGOS3_QT_TYPES_H
#include <cstdio>
#include <string>
#include <type_traits>
#include <vector>

namespace Qt {

enum Key {
  Key_Escape = 0x01000000,
  Key_Tab = 0x01000001,
  Key_Backspace = 0x01000003,
  Key_Return = 0x01000004,
  Key_Enter = 0x01000005,
  Key_Left = 0x01000012,
  Key_Up = 0x01000013,
  Key_Right = 0x01000014,
  Key_Down = 0x01000015,
  Key_Space = 0x20,
  Key_Plus = 0x2b,
  Key_Minus = 0x2d,
  Key_0 = 0x30,
  Key_1,
  Key_2,
  Key_3,
  Key_4,
  Key_5,
  Key_6,
  Key_7,
  Key_8,
  Key_9,
  Key_A = 0x41,
  Key_B,
  Key_C,
  Key_D,
  Key_E,
  Key_F,
  Key_G,
  Key_H,
  Key_I,
  Key_J,
  Key_K,
  Key_L,
  Key_M,
  Key_N,
  Key_O,
  Key_P,
  Key_Q,
  Key_R,
  Key_S,
  Key_T,
  Key_U,
  Key_V,
  Key_W,
  Key_X,
  Key_Y,
  Key_Z
};
enum GlobalColor { white, black, red, green, blue, cyan, magenta, yellow, gray, darkRed, darkGreen, darkBlue };
enum AlignmentFlag {
  AlignLeft = 1,
  AlignRight = 2,
  AlignHCenter = 4,
  AlignTop = 32,
  AlignBottom = 64,
  AlignCenter = 132
};

}  // namespace Qt

class QString {
 public:
  QString() {}
  QString(const char* text) : text_(text) {}
  QString(const std::string& text) : text_(text) {}
  static QString fromStdString(const std::string& text) { return QString(text); }
  static QString number(int value) { return QString(std::to_string(value)); }
  static QString number(unsigned value) { return QString(std::to_string(value)); }
  static QString number(long value) { return QString(std::to_string(value)); }
  static QString number(unsigned long value) { return QString(std::to_string(value)); }
  static QString number(long long value) { return QString(std::to_string(value)); }
  static QString number(unsigned long long value) { return QString(std::to_string(value)); }
  /// `format`: as of printf, with so many digits.
  static QString number(double value, char format = 'g', int precision = 6) {
    const char how[] = {'%', '.', '*', format, '\0'};
    char text[512];
    std::snprintf(text, sizeof text, how, precision, value);
    return QString(text);
  }
  std::string toStdString() const { return text_; }
  /// In the place of the lowest of %1, %2, … that are there.
  QString arg(const QString& value) const {
    for (int i = 1; i < 100; ++i) {
      const std::string place = "%" + std::to_string(i);
      std::size_t at = text_.find(place);
      if (at == std::string::npos) continue;
      std::string filled = text_;
      for (; at != std::string::npos; at = filled.find(place, at + value.text_.size()))
        filled.replace(at, place.size(), value.text_);
      return QString(filled);
    }
    return *this;
  }
  template <typename Number>
  typename std::enable_if<std::is_arithmetic<Number>::value, QString>::type arg(Number value) const {
    return arg(number(value));
  }
  QString& operator+=(const QString& other) {
    text_ += other.text_;
    return *this;
  }
  friend QString operator+(const QString& a, const QString& b) { return QString(a.text_ + b.text_); }

 private:
  std::string text_;
};

class QFont {
 public:
  enum Weight { Light = 25, Normal = 50, Bold = 75 };
  explicit QFont(const QString& = QString(), int = -1, int = -1, bool = false) {}
  void setPointSize(int) {}
  void setBold(bool) {}
};

class QColor {
 public:
  QColor(int red, int green, int blue, int alpha = 255) : red_(red), green_(green), blue_(blue), alpha_(alpha) {}
  QColor(Qt::GlobalColor color);
  int red() const { return red_; }
  int green() const { return green_; }
  int blue() const { return blue_; }
  int alpha() const { return alpha_; }

 private:
  int red_, green_, blue_, alpha_;
};

class QPen {
 public:
  QPen(const QColor& color = QColor(0, 0, 0)) : color_(color) {}
  QPen(Qt::GlobalColor color) : color_(color) {}
  const QColor& color() const { return color_; }

 private:
  QColor color_;
};

class QPoint {
 public:
  QPoint(int x = 0, int y = 0) : x_(x), y_(y) {}
  int x() const { return x_; }
  int y() const { return y_; }

 private:
  int x_, y_;
};

class QRect {
 public:
  QRect(int x = 0, int y = 0, int width = 0, int height = 0) : x_(x), y_(y), width_(width), height_(height) {}
  int x() const { return x_; }
  int y() const { return y_; }
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  int x_, y_, width_, height_;
};

/// Writes texts beside the arena, line by line in the order of their height on the window.
class QPainter {
 public:
  struct SText {
    int X, Y;
    std::string Text;
    QColor Color;
  };
  QPainter() : color_(0, 0, 0) {}
  void setPen(const QPen& pen) { color_ = pen.color(); }
  void setPen(const QColor& color) { color_ = color; }
  void setPen(Qt::GlobalColor color) { color_ = QColor(color); }
  void setFont(const QFont&) {}
  void drawText(int x, int y, const QString& text) { texts_.push_back({x, y, text.toStdString(), color_}); }
  void drawText(const QPoint& at, const QString& text) { drawText(at.x(), at.y(), text); }
  void drawText(const QRect& in, int, const QString& text) { drawText(in.x(), in.y(), text); }
  void drawText(int x, int y, int, int, int, const QString& text) { drawText(x, y, text); }
  const std::vector<SText>& texts() const { return texts_; }

 private:
  QColor color_;
  std::vector<SText> texts_;
};

class QKeyEvent {
 public:
  /// Of a character: letters and digits are those of the keyboard, whatever their case.
  explicit QKeyEvent(char key);
  int key() const { return key_; }
  QString text() const { return QString(std::string(1, text_)); }
  bool isAutoRepeat() const { return false; }
  void accept() {}
  void ignore() {}

 private:
  int key_;
  char text_;
};

class QMouseEvent {};

#endif
