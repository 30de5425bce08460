# Puts the web page of `windlass report` into the program: page.html, page.css, page.js, tube.js and Plotly.
#
# Plotly (MIT) is fetched from npm once a build folder and not kept in the repository. Without npm or without network
# the program is built all the same; `windlass report` then says what is missing.
set(WINDLASS_PLOTLY_PACKAGE plotly.js-gl3d-dist-min)
set(WINDLASS_PLOTLY_VERSION 3.3.1)
set(plotly_folder ${CMAKE_BINARY_DIR}/plotly)
set(plotly_file ${plotly_folder}/node_modules/${WINDLASS_PLOTLY_PACKAGE}/plotly-gl3d.min.js)

find_program(WINDLASS_NPM npm)
if(WINDLASS_NPM AND NOT EXISTS ${plotly_file})
  file(MAKE_DIRECTORY ${plotly_folder})
  message(STATUS "Fetching ${WINDLASS_PLOTLY_PACKAGE} ${WINDLASS_PLOTLY_VERSION} from npm")
  execute_process(
    COMMAND ${WINDLASS_NPM} install --prefix ${plotly_folder} --no-save --ignore-scripts --no-audit --no-fund
            --loglevel=error ${WINDLASS_PLOTLY_PACKAGE}@${WINDLASS_PLOTLY_VERSION}
    RESULT_VARIABLE plotly_status OUTPUT_QUIET ERROR_VARIABLE plotly_error TIMEOUT 120)
  if(plotly_status)
    message(WARNING "Plotly could not be fetched; `windlass report` will not work: ${plotly_error}")
  endif()
endif()

set(report_assets ${CMAKE_CURRENT_LIST_DIR}/assets.cpp)
set(report_inputs ${CMAKE_CURRENT_LIST_DIR}/page.html ${CMAKE_CURRENT_LIST_DIR}/page.css
    ${CMAKE_CURRENT_LIST_DIR}/page.js ${CMAKE_CURRENT_LIST_DIR}/tube.js)
set(report_definitions WINDLASS_REPORT_FOLDER="${CMAKE_CURRENT_LIST_DIR}")
if(EXISTS ${plotly_file})
  list(APPEND report_inputs ${plotly_file})
  list(APPEND report_definitions WINDLASS_PLOTLY_FILE="${plotly_file}")
endif()
set_source_files_properties(${report_assets} PROPERTIES OBJECT_DEPENDS "${report_inputs}"
                            COMPILE_DEFINITIONS "${report_definitions}")
