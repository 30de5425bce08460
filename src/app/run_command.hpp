#pragma once

#include <memory>

#include "app/commands.hpp"

namespace windlass::app {

/// Gives a command its RUN, what it does once everything is parsed, and a request for its further options to fill.
template <class Request>
std::shared_ptr<Request> add_run(Command& command, CommonOptions& common, int& status,
                                 int (*body)(const Request&)) {
  const auto request = std::make_shared<Request>();
  command.add("RUN", request->run, "run folder").required().type("");
  command.run([request, body, &common, &status] {
    request->common = common;
    scene_of_run(request->run, common);  // tells a folder that is no run from one that is
    status = body(*request);
  });
  return request;
}

}  // namespace windlass::app
