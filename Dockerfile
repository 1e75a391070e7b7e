# The program in a container: docs/platforms.md says how it is used.
#
#   docker build -t raymoval .            (or podman build, or buildah bud)
#   docker run --rm -u "$(id -u):$(id -g)" -v "$PWD:/data" raymoval clean my_scans -o static.pcd
#
# --build-arg DEBIAN=13-slim takes another Debian.
ARG DEBIAN=12-slim

FROM docker.io/library/debian:${DEBIAN} AS build
WORKDIR /src
# Alone, so that a change of the source does not install all packages again. git says which commit
# is built. The slim image has no folders for manual pages, without which Java, which libpcl-dev
# depends on, is not installed.
COPY scripts/install_dependencies.sh scripts/
RUN mkdir -p /usr/share/man/man1 && apt-get update && apt-get install --yes --no-install-recommends git ca-certificates dpkg-dev file && scripts/install_dependencies.sh
COPY . .
ARG JOBS=
RUN cmake --preset release -DRAYMOVAL_BUILD_TESTS=OFF
RUN cmake --build build/release -j ${JOBS:-$(nproc)}
RUN cd build/release && cpack -G DEB -B /packages

FROM docker.io/library/debian:${DEBIAN}
COPY --from=build /packages/*.deb /tmp/
RUN apt-get update && apt-get install --yes --no-install-recommends /tmp/raymoval_*.deb && rm -rf /tmp/*.deb /var/lib/apt/lists/*
# Nobody in particular: whoever runs it says who they are by -u, so that what is written is theirs.
RUN useradd --create-home --uid 1000 raymoval && install -d -m 1777 /cache && install -d -o raymoval /data
ENV RAYMOVAL_CACHE=/cache
USER raymoval
WORKDIR /data
ENTRYPOINT ["raymoval"]
CMD ["--help"]
