// Number types of ARGoS.
#ifndef TANDEM_ARGOS3_DATATYPES_H
#define TANDEM_ARGOS3_DATATYPES_H
// Users rely on what ARGoS' headers include.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>
#include <string>
#include <string.h>
#include <unistd.h>
#include <vector>

#include <argos3/core/config.h>

namespace argos {

typedef double Real;
typedef signed char SInt8;
typedef unsigned char UInt8;
typedef signed short SInt16;
typedef unsigned short UInt16;
typedef signed int SInt32;
typedef unsigned int UInt32;
typedef signed long long SInt64;
typedef unsigned long long UInt64;

// Bytes are written as numbers inside the namespace, not as characters.
inline std::ostream& operator<<(std::ostream& out, const SInt8 value) {
  return out << static_cast<int>(value);
}
inline std::ostream& operator<<(std::ostream& out, const UInt8 value) {
  return out << static_cast<unsigned>(value);
}

}  // namespace argos

#endif
