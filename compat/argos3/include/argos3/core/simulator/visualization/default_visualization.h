#ifndef TANDEM_ARGOS3_DEFAULT_VISUALIZATION_H
#define TANDEM_ARGOS3_DEFAULT_VISUALIZATION_H
#include <argos3/core/simulator/visualization/visualization.h>
#endif
