# User functions of ARGoS' Qt view are drawn in Tandem's window: no Qt is needed.
get_filename_component(argos_prefix ${CMAKE_CURRENT_LIST_DIR}/../../.. ABSOLUTE)
set(ARGOS_QTOPENGL_FOUND TRUE)
set(ARGOS_COMPILE_QTOPENGL TRUE)
set(ARGOS_QTOPENGL_INCLUDE_DIRS ${argos_prefix}/include)
set(ARGOS_QTOPENGL_LIBRARIES ${argos_prefix}/lib/argos3/libargos3plugin_simulator_qtopengl.a)
