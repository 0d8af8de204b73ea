# `fdcc` in a small image:
#
#     docker build -t fdcc .
#     docker run --rm -v "$PWD:/models" fdcc solve block.fdc
FROM rust:1.95-slim AS build
RUN apt-get update && apt-get install --yes --no-install-recommends git && rm -rf /var/lib/apt/lists/*
COPY . /source
WORKDIR /source
# The compiler of the image, not the newest one that `rust-toolchain.toml` asks for.
RUN rm rust-toolchain.toml && cargo build --release --locked --package fdcc-cli

FROM debian:stable-slim
COPY --from=build /source/target/release/fdcc /usr/local/bin/fdcc
WORKDIR /models
ENTRYPOINT ["fdcc"]
