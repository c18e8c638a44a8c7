// Colours of a terminal, which the log does not have: they write nothing.
#ifndef TANDEM_ARGOS3_COLORED_TEXT_H
#define TANDEM_ARGOS3_COLORED_TEXT_H
#include <iostream>

namespace argos {

inline std::ostream& red(std::ostream& out) {
  return out;
}
inline std::ostream& green(std::ostream& out) {
  return out;
}
inline std::ostream& yellow(std::ostream& out) {
  return out;
}
inline std::ostream& blue(std::ostream& out) {
  return out;
}
inline std::ostream& magenta(std::ostream& out) {
  return out;
}
inline std::ostream& cyan(std::ostream& out) {
  return out;
}
inline std::ostream& white(std::ostream& out) {
  return out;
}
inline std::ostream& reset(std::ostream& out) {
  return out;
}

}  // namespace argos

#endif
