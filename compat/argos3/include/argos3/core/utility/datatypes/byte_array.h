// Bytes in a row, as messages carry them.
#ifndef TANDEM_ARGOS3_BYTE_ARRAY_H
#define TANDEM_ARGOS3_BYTE_ARRAY_H
#include <iostream>
#include <string>
#include <sys/types.h>
#include <type_traits>
#include <vector>

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/datatypes.h>

namespace argos {

/// `<<` appends and `>>` takes from the front: whole numbers and enumerators with their highest byte first, texts with a zero at their
/// end, real numbers as a whole part and an exponent.
class CByteArray {
  template <typename T>
  static constexpr bool IsWhole() {
    return std::is_integral<T>::value || std::is_enum<T>::value;
  }

 public:
  CByteArray() {}
  CByteArray(const UInt8* bytes, size_t size) : m_vecBuffer(bytes, bytes + size) {}
  CByteArray(size_t size, UInt8 value = 0) : m_vecBuffer(size, value) {}

  size_t Size() const { return m_vecBuffer.size(); }
  void Resize(size_t size, UInt8 value = 0) { m_vecBuffer.resize(size, value); }
  void Swap(CByteArray& other) { m_vecBuffer.swap(other.m_vecBuffer); }
  bool Empty() const { return m_vecBuffer.empty(); }
  /// Null when it is empty.
  const UInt8* ToCArray() const { return Empty() ? nullptr : m_vecBuffer.data(); }
  UInt8* ToCArray() { return Empty() ? nullptr : m_vecBuffer.data(); }
  void Clear() { m_vecBuffer.clear(); }
  /// Keeps its size.
  void Zero() { m_vecBuffer.assign(m_vecBuffer.size(), 0); }

  UInt8& operator[](size_t i) {
    Check(i);
    return m_vecBuffer[i];
  }
  UInt8 operator[](size_t i) const {
    Check(i);
    return m_vecBuffer[i];
  }
  bool operator==(const CByteArray& other) const { return m_vecBuffer == other.m_vecBuffer; }
  bool operator!=(const CByteArray& other) const { return !(*this == other); }

  CByteArray& AddBuffer(const UInt8* bytes, size_t size);
  /// @throws CARGoSException when there are fewer
  CByteArray& FetchBuffer(UInt8* bytes, size_t size);
  template <typename T>
  T PopFront() {
    T value = T();
    *this >> value;
    return value;
  }
  /// A new array of the bytes from `start` to before `end`, which its caller deletes; -1: to the last.
  CByteArray* operator()(size_t start, ssize_t end = -1) const;

  template <typename T>
  typename std::enable_if<IsWhole<T>(), CByteArray&>::type operator<<(T value) {
    return Append(static_cast<UInt64>(value), sizeof(T));
  }
  template <typename T>
  typename std::enable_if<IsWhole<T>(), CByteArray&>::type operator>>(T& value) {
    value = static_cast<T>(Fetch(sizeof(T)));
    return *this;
  }
  CByteArray& operator<<(double value);
  CByteArray& operator>>(double& value);
  CByteArray& operator<<(float value);
  CByteArray& operator>>(float& value);
  CByteArray& operator<<(const std::string& value);
  CByteArray& operator>>(std::string& value);

  friend std::ostream& operator<<(std::ostream& out, const CByteArray& bytes);

 private:
  CByteArray& Append(UInt64 value, size_t size);
  UInt64 Fetch(size_t size);
  void Check(size_t i) const {
    if (i >= Size()) THROW_ARGOSEXCEPTION("a CByteArray of " << Size() << " bytes has no byte " << i)
  }
  std::vector<UInt8> m_vecBuffer;
};

std::ostream& operator<<(std::ostream& out, const CByteArray& bytes);

}  // namespace argos

#endif
