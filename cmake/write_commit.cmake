# cmake -DSOURCE=<checkout> -DOUT=<file.cpp> -P write_commit.cmake: writes the commit that is built, if it is another than the
# file says. Runs with every build; the file is one small object, so a commit compiles nothing else.
set(commit "")
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse --show-toplevel OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  file(REAL_PATH ${SOURCE} source)
  if(top STREQUAL source) # else the checkout was copied into somebody else's repository
    execute_process(COMMAND ${GIT} -C ${SOURCE} rev-parse HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    execute_process(COMMAND ${GIT} -C ${SOURCE} --no-optional-locks diff-index --quiet HEAD -- RESULT_VARIABLE changed ERROR_QUIET OUTPUT_QUIET)
    if(changed AND commit)
      string(APPEND commit " with changes")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "// The commit that was built; written by every build.\nextern const char* const kTandemCommit;\nconst char* const kTandemCommit = \"${commit}\";\n")
