# The modules of the program (app/module/module_table.hpp says what each needs, as here); `tandem_modules` are all of them, and
# all controllers and hooks.
if(TANDEM_BOARD OR TANDEM_SANITIZE)
  return() # they are linked in
endif()
set(of_window live pictures)
set(of_real live)
set(of_lab dynamics live pictures real window study)
foreach(module dynamics live pictures real window study lab argos3)
  tandem_wants(${module})
  if(wanted)
    tandem_module(${module} NEEDS ${of_${module}})
  endif()
endforeach()
if(TARGET tandem_module_argos3)
  add_dependencies(tandem_module_argos3 tandem_argos3_plugin argos_diffusion) # users' libraries are built with it
endif()
get_property(modules GLOBAL PROPERTY TANDEM_MODULES)
get_property(plugins GLOBAL PROPERTY TANDEM_PLUGINS)
add_custom_target(tandem_modules DEPENDS tandem ${modules} ${plugins})
