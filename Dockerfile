# ellipsoidTrapFoam on Debian 12 with Debian's OpenFOAM:
#   docker build -t ellipsoidtrapfoam . && docker run -it ellipsoidtrapfoam
FROM debian:12
COPY . /opt/ellipsoidTrapFoam
WORKDIR /opt/ellipsoidTrapFoam
# The set-up brings OpenFOAM, compilers and Python, as on any bare Debian
RUN bash -c '. Make/setup.sh && setup_environment run' && ./Allwmake \
    && apt-get clean && rm -rf /var/lib/apt/lists/*
CMD ["bash", "-c", ". Make/setup.sh && setup_environment run && exec bash"]
