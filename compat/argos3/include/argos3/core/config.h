// Settings of this build that ARGoS' users test in their sources.
#ifndef TANDEM_ARGOS3_CONFIG_H
#define TANDEM_ARGOS3_CONFIG_H

#define ARGOS_VERSION "3.0.0"
#define ARGOS_RELEASE "tandem"
#define ARGOS_BUILD_FOR "simulator"
#define ARGOS_BUILD_FOR_SIMULATOR
#define ARGOS_DYNAMIC_LIBRARY_LOADING
#define ARGOS_SHARED_LIBRARY_EXTENSION "so"
#define ARGOS_MODULE_LIBRARY_EXTENSION "so"
#define ARGOS_USE_DOUBLE
#define ARGOS_THREADSAFE_LOG
/* True here and nowhere else: for sources that must tell the two apart. */
#define ARGOS_IS_TANDEM 1

#endif
