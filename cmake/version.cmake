# cmake -DSOURCE=... -DVERSION=... -DBUILD_ID=... -DOUT=version.cpp -P version.cmake
# Writes appliance::version(). It runs at every build, because the build may have been configured at
# another commit. The file keeps its time when nothing changed, so that nothing is built again.
set(id "${BUILD_ID}")
if(NOT id)
  find_program(GIT git)
  if(GIT AND EXISTS ${SOURCE}/.git)
    execute_process(COMMAND ${GIT} -c safe.directory=* -C ${SOURCE} describe --always --dirty
      --abbrev=10 --exclude=*
      OUTPUT_VARIABLE id OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  endif()
endif()
if(NOT id)
  set(id "commit unknown")
endif()
set(text "#include \"appliance/version/version.h\"

std::string_view appliance::version() {
  return \"${VERSION} (${id})\";
}
")
set(old "")
if(EXISTS ${OUT})
  file(READ ${OUT} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${OUT} "${text}")
endif()
