# The modules of the program (app/module/module_table.hpp says what each needs, as here).
if(TANDEM_BOARD OR TANDEM_SANITIZE)
  return() # they are linked in
endif()
tandem_module(live)
tandem_module(pictures)
tandem_module(real NEEDS live)
tandem_module(window NEEDS live pictures)
tandem_module(study)
tandem_module(lab NEEDS live pictures real window study)
