# What was built can be installed and run from there.  cmake -D BUILD=folder -P install.cmake
set(prefix ${BUILD}/install_test)
set(ENV{ASAN_OPTIONS} detect_leaks=0)  # of MPI and its libraries
file(REMOVE_RECURSE ${prefix})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix} OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
foreach(file share/man/man1/windlass.1 share/bash-completion/completions/windlass
        share/windlass/scenes/strengths-example.csv)
  if(NOT EXISTS ${prefix}/${file})
    message(FATAL_ERROR "${file} is not installed")
  endif()
endforeach()
execute_process(COMMAND bin/windlass scenes WORKING_DIRECTORY ${prefix} OUTPUT_VARIABLE scenes COMMAND_ERROR_IS_FATAL ANY)
if(NOT scenes MATCHES "\nshare/windlass/scenes/capstan-2pi.toml")  # not those of the sources
  message(FATAL_ERROR "the installed program lists\n${scenes}")
endif()
execute_process(COMMAND bin/windlass solve share/windlass/scenes/capstan-2pi.toml --quiet WORKING_DIRECTORY ${prefix}
                COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE_RECURSE ${prefix})
