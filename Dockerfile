# Builds the Debian package, and installs it on a Debian 12 without compilers:
#   docker build -t zerocount .
#   docker run --rm -v "$PWD:/work" zerocount run study.yaml -o study.h5
FROM docker.io/library/debian:bookworm-slim AS build
COPY . /zerocount
WORKDIR /zerocount
RUN ./quickstart package

FROM docker.io/library/debian:bookworm-slim
COPY --from=build /zerocount/build/portable/zerocount_*.deb /
RUN apt-get update -qq \
 && apt-get install -y -qq --no-install-recommends /zerocount_*.deb \
 && rm -rf /zerocount_*.deb /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["zerocount"]
