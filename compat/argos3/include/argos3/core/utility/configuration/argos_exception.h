// The exception of ARGoS, and the macros that throw it.
#ifndef TANDEM_ARGOS3_EXCEPTION_H
#define TANDEM_ARGOS3_EXCEPTION_H
#include <exception>
#include <sstream>
#include <stdexcept>
#include <string>

namespace argos {

/// The texts of nested exceptions follow the outer one, a line each.
class CARGoSException : public std::exception {
 public:
  CARGoSException(const std::string& what, std::exception* nested = nullptr) noexcept;
  CARGoSException(const CARGoSException&) = default;
  CARGoSException& operator=(const CARGoSException&) = default;
  virtual ~CARGoSException() noexcept;
  virtual const char* what() const noexcept;

 private:
  std::string m_strWhat;
};

}  // namespace argos

#define THROW_ARGOSEXCEPTION(message)                            \
  {                                                              \
    ::std::ostringstream tandem_what;                            \
    tandem_what << message;                                      \
    throw ::argos::CARGoSException(tandem_what.str());           \
  }

#define THROW_ARGOSEXCEPTION_NESTED(message, nested)             \
  {                                                              \
    ::std::ostringstream tandem_what;                            \
    tandem_what << message;                                      \
    throw ::argos::CARGoSException(tandem_what.str(), &(nested)); \
  }

#ifndef NDEBUG
#define ARGOS_ASSERT(condition, message)          \
  {                                               \
    if (!(condition)) THROW_ARGOSEXCEPTION(message) \
  }
#else
#define ARGOS_ASSERT(condition, message)
#endif

#endif
