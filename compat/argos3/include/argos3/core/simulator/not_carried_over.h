// Compile-time messages for what Tandem's ARGoS headers leave out.
#ifndef ARGOS3_CORE_SIMULATOR_NOT_CARRIED_OVER_H
#define ARGOS3_CORE_SIMULATOR_NOT_CARRIED_OVER_H

/// At the scope of a file or a class: whoever writes it gets the message.
#define ARGOS3_NOT_CARRIED_OVER(message) static_assert(false, "Tandem carries this over from ARGoS 3 not: " message)

/// A member function: whoever calls it gets the message.
#define ARGOS3_NO_FUNCTION(name, message)                                                             \
  template <typename... ARGUMENTS>                                                                    \
  void name(ARGUMENTS&&...) const {                                                                   \
    static_assert(sizeof...(ARGUMENTS) > 1000, "Tandem does not have ARGoS 3's " #name ": " message); \
  }

#endif
