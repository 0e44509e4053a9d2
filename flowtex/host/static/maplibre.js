// Built from client/src by client/build.js; change that instead.
/*! Holds parts of gl-matrix, of which this is the licence:

Copyright (c) 2015-2025, Brandon Jones, Colin MacKenzie IV.

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in
all copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN
THE SOFTWARE. */
/*! Holds parts of zarrita, of which this is the licence:

MIT License

Copyright (c) 2020-2023 Trevor Manz

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE. */
function ja(a){let e=a>>10&31,t=a&1023,r;return e===0?r=t*2**-24:e===31?r=t?NaN:1/0:r=(1024+t)*2**(e-25),a&32768?-r:r}var Re=Float32Array.
from({length:65536},(a,e)=>ja(e)),Yr=new Float32Array(1),jr=new Uint32Array(Yr.buffer);function Xr(a){Yr[0]=a;let e=jr[0]>>>
16&32768,t=jr[0]&2147483647;return t>=1199566848?e|(t>2139095040?32256:31744):t<947912704?e|Math.round(Math.abs(a)*2**24):
e|t-93952e4>>>13}function ur(a,e,t,r=1){let n=a.getParameter(a.MAX_TEXTURE_SIZE),s=a.getParameter(a.MAX_ARRAY_TEXTURE_LAYERS);
if(Math.max(e,t)>n||r>s)throw new Error(`a texture of ${e} x ${t} texels in ${r} layers is needed, but this graphics car\
d supports at most ${n} x ${n} in ${s}; show fewer nodes`)}function Qe(a,e,t){let{width:r,height:n,layers:s,channels:o,levels:i}=t;
ur(a,r,n,s);let c=a.TEXTURE_2D_ARRAY;a.bindTexture(c,e),a.texStorage3D(c,i+1,o===1?a.R16F:a.RGBA16F,r,n,s),a.texParameteri(
c,a.TEXTURE_MIN_FILTER,a.LINEAR_MIPMAP_LINEAR),a.texParameteri(c,a.TEXTURE_MAG_FILTER,a.LINEAR),a.texParameteri(c,a.TEXTURE_WRAP_S,
a.CLAMP_TO_EDGE),a.texParameteri(c,a.TEXTURE_WRAP_T,a.CLAMP_TO_EDGE)}var Jr=["coastlines","graticule"],Me={critical:"critical_points",separatrices:"separatrices",nullclines:"nullclines"},et={
saddle:8,orbit:4,leaving:2},qr={float32:Float32Array,uint32:Uint32Array,float16:Uint16Array,uint16:Uint16Array,int16:Int16Array,
int8:Int8Array,uint8:Uint8Array};function mr({low:a,high:e,log:t}){if(!t)return n=>(n-a)/(e-a||1);let r=Math.log(e/a)||1;
return n=>Math.log(Math.max(n,a)/a)/r}function ue(a){return a.variant.includes("FLOWTEX_SIGNFREE")}function X(a){return Number(a.split("/")[1])}function Ee(a,e,{
scalars:t}){let[r,n,s="0"]=a.split("/"),o=t.choices[Number(s)]?.steps??t.steps;return r==="scalars"&&Number(n)===e&&o>1}
function me(a){let[e,t,r,n,...s]=a.split("/");return e==="tile"?[[t,r,n].join("/"),s.join("/")]:null}function Zr(a,e){let t=ArrayBuffer.
isView(e)?new Uint8Array(e.buffer,e.byteOffset,e.byteLength):new Uint8Array(e),{name:r,dtype:n,shape:s,digest:o}=a,i=qr[n];
if(!i)throw new Error(`a part has the type "${n}"; expected ${Object.keys(qr).join(", ")}`);return{name:r,shape:s,digest:o,
data:new i(t.slice().buffer)}}function Qr(a){let[e,t]=pr(new Uint8Array(a)),r=t;return e.map(n=>{let s=new Uint8Array(a,
r,n.bytes);return r+=n.bytes,n.differences===void 0?Zr(n,s):tn(n,s)})}function pr(a){let e=4+new DataView(a.buffer,a.byteOffset).
getUint32(0,!0);return[JSON.parse(new TextDecoder().decode(a.subarray(4,e))),e]}async function en(a,e){return tn(a,new Uint8Array(
await Ya(e).arrayBuffer()))}function Ya(a){let e=atob(a),t=new Uint8Array(e.length);for(let r=0;r<t.length;r+=1)t[r]=e.charCodeAt(
r);return new Response(new Blob([t]).stream().pipeThrough(new DecompressionStream("gzip")))}var Kr={1:Uint8Array,2:Uint16Array,
4:Uint32Array};function tn(a,e){let{shape:t,differences:r=[0,0],scale:n=null}=a,s=t.reduce((u,m)=>u*m,1),o=s?e.length/s:
1;if(!(o in Kr))throw new Error(`the packing of the part "${a.name}" is invalid`);let[i,c]=t.length>2?t.slice(-2):[...t,
1].slice(-2),l=new Kr[o](s);for(let u=0,m=0;u<c;u+=1)for(let p=u;p<s;p+=c,m+=1){let f=0;for(let d=0;d<o;d+=1)f|=e[d*s+m]<<
8*d;l[p]=f>>>1^-(f&1)}let h=i*c;for(let u=0;u<r[0];u+=1)for(let m=h;m<s;m+=1)l[m]+=l[m-h];for(let u=0;u<r[1];u+=1)for(let m=0;m<
s;m+=h)for(let p=m+c;p<m+h;p+=1)l[p]+=l[p-c];return Zr(a,n?Xa(l,n.map(u=>2**u)):l)}function Xa(a,e){let t=e.length;return a instanceof
Uint16Array?a.map((r,n)=>Xr((r<<16>>16)*e[n%t])):new Float32Array(new Float64Array(a).map((r,n)=>(r|0)*e[n%t]))}var fr=1e-6,tt=typeof Float32Array<"u"?Float32Array:Array;var tl=Math.PI/180,rl=180/Math.PI;function nn(a,e){if(a===e){var t=e[1],r=e[2],n=e[5];a[1]=e[3],a[2]=e[6],a[3]=t,a[5]=e[7],a[6]=r,a[7]=n}else a[0]=e[0],a[1]=
e[3],a[2]=e[6],a[3]=e[1],a[4]=e[4],a[5]=e[7],a[6]=e[2],a[7]=e[5],a[8]=e[8];return a}function sn(a,e,t){var r=t[0],n=t[1],s=t[2],o=Math.sqrt(r*r+n*n+s*s),i,c,l;return o<fr?null:(o=1/o,r*=o,n*=o,s*=o,i=Math.
sin(e),c=Math.cos(e),l=1-c,a[0]=r*r*l+c,a[1]=n*r*l+s*i,a[2]=s*r*l-n*i,a[3]=0,a[4]=r*n*l-s*i,a[5]=n*n*l+c,a[6]=s*n*l+r*i,
a[7]=0,a[8]=r*s*l+n*i,a[9]=n*s*l-r*i,a[10]=s*s*l+c,a[11]=0,a[12]=0,a[13]=0,a[14]=0,a[15]=1,a)}function Ja(){var a=new tt(3);return tt!=Float32Array&&(a[0]=0,a[1]=0,a[2]=0),a}function an(a){var e=a[0],t=a[1],r=a[2];return Math.sqrt(e*e+t*t+r*r)}function on(a,e,t){return a[0]=e[0]-t[0],a[1]=e[1]-t[1],a[2]=e[2]-t[2],a}function cn(a,e,t){return a[0]=e[0]*t,a[1]=e[1]*t,a[2]=e[2]*t,a}function ln(a,e,t,r){return a[0]=e[0]+t[0]*r,a[1]=e[1]+t[1]*
r,a[2]=e[2]+t[2]*r,a}function hn(a,e){var t=e[0],r=e[1],n=e[2],s=t*t+r*r+n*n;return s>0&&(s=1/Math.sqrt(s)),a[0]=e[0]*s,a[1]=e[1]*s,a[2]=e[2]*
s,a}function un(a,e){return a[0]*e[0]+a[1]*e[1]+a[2]*e[2]}function mn(a,e,t){var r=e[0],n=e[1],s=e[2],o=t[0],i=t[1],c=t[2];
return a[0]=n*c-s*i,a[1]=s*o-r*c,a[2]=r*i-n*o,a}function pn(a,e,t){var r=e[0],n=e[1],s=e[2],o=t[3]*r+t[7]*n+t[11]*s+t[15];return o=o||1,a[0]=(t[0]*r+t[4]*n+t[8]*s+t[12])/
o,a[1]=(t[1]*r+t[5]*n+t[9]*s+t[13])/o,a[2]=(t[2]*r+t[6]*n+t[10]*s+t[14])/o,a}function dr(a,e,t){var r=e[0],n=e[1],s=e[2];
return a[0]=r*t[0]+n*t[3]+s*t[6],a[1]=r*t[1]+n*t[4]+s*t[7],a[2]=r*t[2]+n*t[5]+s*t[8],a}var al=(function(){var a=Ja();return function(e,t,r,n,s,o){var i,c;for(t||(t=3),r||(r=0),n?c=Math.min(n*t+r,e.length):c=
e.length,i=r;i<c;i+=t)a[0]=e[i],a[1]=e[i+1],a[2]=e[i+2],s(a,a,o),e[i]=a[0],e[i+1]=a[1],e[i+2]=a[2];return e}})();var W=a=>a,te=()=>[0,0,0],fn=a=>new Array(a).fill(0),T=(a,e)=>un(W(a),W(e)),O=a=>an(W(a)),E=(a,e)=>on(te(),W(a),W(e)),k=(a,e)=>cn(
te(),W(a),e),N=(a,e)=>mn(te(),W(a),W(e)),C=a=>hn(te(),W(a)),A=(a,e,t=1)=>ln(te(),W(a),W(e),t);function rt(a,e,t){let r=sn(
fn(16),t*Math.PI/180,W(e));return r===null?te():pn(te(),W(a),r)}function F(a,e){let t=nn(fn(9),a);return dr(te(),W(e),t)}
function K(a,e){return dr(te(),W(e),a)}function P(a,e,t){return Math.min(Math.max(a,e),t)}var Qa="own cmap";var dn=256;function eo({scalars:a},e,t,r){let{entries:n,flip:s,maps:o}=a,i=r?r.slice():new Uint8Array(4*n).fill(255),c=i.
length/4-1||1;return i.map((l,h)=>{let[u,m]=[h>>2,h&3],p=Math.round((s?c-u:u)/c*(dn-1));return m===3?l:e[3*(o.indexOf(t)*
dn+p)+m]})}function gn(a,{beyond:e}){let t=a.length/4,r=a instanceof Float32Array;return Float32Array.from({length:a.length+
12},(n,s)=>{let[o,i]=[s>>2,s&3],c=a[4*P(o-1,0,t-1)+i];return i===3?r?o?c:1:0:(o>t?e[o-t]:o?null:e[0])?.[i]??c/255})}function bn(a,e,t){let r={...a.scalars};e.scalars===!1&&(r.name=null);let n=r.choices.findIndex(({name:b})=>b===e.scalars);
if(n>=0){let{name:b,label:y,unit:x,steps:v,flat:w}=r.choices[n];Object.assign(r,{name:b,label:y,unit:x,steps:v,flat:w,number:n,
auto:!0})}if(e.cmap&&(r.cmap=e.cmap),Array.isArray(e.clim)&&([r.low,r.high]=e.clim),e.clim!==void 0&&(r.auto=!e.clim),r.
auto&&r.choices[r.number]){let{cmap:b="",least:y,...x}=r.choices[r.number],v=r.log&&y>0,[w,M]=v?[y,x.most]:[x.low,x.high],
S=(w<0&&M>0||r.diverging.includes(b))&&r.diverging.includes(r.cmap),R=Math.max(-w,M);[r.low,r.high]=S?[-R,R]:[w,M]}let{coastlines:s=a.
earth?.coastlines,graticule:o=a.earth?.graticule}=e,i=a.earth&&{...a.earth,coastlines:s,graticule:o},{opacity:c=a.opacity}=e,
l={scalars:r,earth:i,opacity:c},[h,u]=[t.get("maps"),t.get("cmap")?.data],m=u instanceof Float32Array,p=m&&(e.clim!==void 0||
e.scalars!==void 0);if(!h||!(e.cmap||p))return{colours:l,part:null};p&&Object.assign(r,{ticks:[],beyond:[null,null,r.beyond[2]]});
let f=m&&!p,d=e.cmap?eo(a,h.data,e.cmap,f?u:void 0):Uint8Array.from(u??[]),g=[Qa,e.cmap,f].join();return{colours:l,part:{
name:"cmap",data:d,shape:[d.length/4,4],digest:g}}}var gr=[0,0,1],yn=Math.sin(89*Math.PI/180),to=.2;var pe=a=>Math.tan(a*Math.PI/360),fe=class{flat;limits;aspect;state;start;pick=null;globe;homeHeight;nearest;constructor(e,t,r,n=1,s=0){
this.state=br(e),this.start=br(e),this.limits=t,this.flat=r,this.globe=s,this.aspect=n,this.homeHeight=this.height,this.
nearest=this.distance/t.closest}get height(){let{parallel:e,parallel_scale:t,view_angle:r}=this.state;return e?t:this.distance*
pe(r)}get distance(){return O(E(this.state.focal_point,this.state.position))}get zoom(){return this.homeHeight/this.height}get axes(){
let e=C(E(this.state.focal_point,this.state.position)),t=C(N(e,this.state.up));return[t,N(t,e),e]}sight(e){let{parallel:t,
position:r,view_angle:n}=this.state;return t?{eye:null,halfHeight:this.height,pixels:e}:{eye:r,halfHeight:pe(n),pixels:e}}get planes(){
let[e,t,r]=this.axes,{parallel:n,parallel_scale:s,view_angle:o}=this.state,{position:i,focal_point:c}=this.state,l=n?s:pe(
o);return[e,k(e,-1),t,k(t,-1)].map((h,u)=>{let m=u<2?l*this.aspect:l;if(n)return[...h,m-T(h,c)];let p=A(h,r,m);return[...p,
-T(p,i)]})}get eye(){return this.state.parallel?[...k(this.axes[2],-1),0]:[...this.state.position,1]}at(e){let t=this.axes[2];
if(this.state.parallel)return{height:this.height,ray:t};let r=E(e,this.state.position);return{height:T(r,t)*pe(this.state.
view_angle),ray:C(r)}}project(e){let[t,r]=this.axes,{height:n}=this.at(e);if(!(n>0))return null;let{parallel:s,position:o,
focal_point:i}=this.state,c=E(e,s?i:o);return[T(t,c)/n/this.aspect,T(r,c)/n]}pan(e,t){let[r,n]=this.axes,{height:s}=this;
this.shift(A(k(r,e*this.aspect*s),n,t*s))}rotate(e,t){if(this.globe)return this.roam(e,t);let{state:r,limits:n}=this,s=C(
r.up),o=E(r.position,r.focal_point);o=rt(o,s,-n.turn*e*Math.min(this.aspect,n.widest_turn));let i=C(N(s,o));o=rt(o,i,n.turn*
t),r.position=A(r.focal_point,o),r.up=C(N(o,i))}roam(e,t){let{state:r,limits:n,globe:s}=this,o=O(r.position),i=Math.max(
o-s,0)*pe(r.view_angle),c=r.parallel?r.parallel_scale:i,l=Math.min(c/s*180/Math.PI,n.turn),h=Math.hypot(r.position[0],r.
position[1])/o,u=Math.min(l*this.aspect/Math.max(h,to),n.turn);this.turn(gr,-u*e);let[m]=this.axes,p=Math.abs(r.position[2])/
o,f=br(r);this.turn(m,l*t),Math.abs(r.position[2])/o>Math.max(yn,p)&&(this.state=f);let[,,g]=this.axes,b=A(gr,g,-T(gr,g));
O(b)>1-yn&&(this.state.up=C(b))}turn(e,t){let{state:r}=this;for(let n of["position","focal_point","up"])r[n]=rt(r[n],e,t)}zoomBy(e,t=0,r=0){
if(!Number.isFinite(e)||e<=0)return;this.flat||this.focusAt(t,r);let{farthest_zoom:n,deepest_zoom:s}=this.limits,o=P(e,n/
this.zoom,s/this.zoom),[i,c,l]=this.axes,h=this.height*(1-1/o);this.shift(A(k(i,t*this.aspect*h),c,r*h)),this.state.parallel?
this.state.parallel_scale/=o:this.approach(this.height/o,l)}ray(e,t){let[r,n,s]=this.axes,{height:o,state:i}=this,c=A(A(
i.focal_point,r,e*this.aspect*o),n,t*o);return i.parallel?[A(c,s,-this.distance),s]:[A(i.position,[0,0,0]),C(E(c,i.position))]}approach(e,t){
let r=Math.max(e/pe(this.limits.view_angle),this.nearest);this.state.position=A(this.state.focal_point,t,-r),this.state.
view_angle=Math.atan(e/r)*360/Math.PI}focusAt(e,t){let r=this.pick?.(e,t);if(!r)return;let n=this.axes[2],s=T(E(r,this.state.
position),n);s>0&&(this.state.focal_point=A(this.state.position,n,s))}shift(e){this.state.focal_point=A(this.state.focal_point,
e),this.state.position=A(this.state.position,e)}};function br(a){let{position:e,focal_point:t,up:r}=a;return{...a,position:[
...e],focal_point:[...t],up:[...r]}}function z(a,e,t){let{state:r,aspect:n}=e,{center:s,extent:o,frame:i}=a,[c,l,h]=e.axes.map(S=>F(i,S)),u=S=>E(F(i,E(S,s)),
t),m=u(r.focal_point),p=k(t,-1),f=Math.max(.51*o,a.reach??0),d=new Array(16).fill(0),g=r.parallel?r.parallel_scale:pe(r.
view_angle);if([c.map(S=>S/g/n),l.map(S=>S/g)].forEach((S,R)=>{for(let L=0;L<3;L+=1)d[4*L+R]=S[L];d[12+R]=-T(S,m)}),r.parallel){
for(let S=0;S<3;S+=1)d[4*S+2]=h[S]/f;return d[14]=-T(h,p)/f,d[15]=1,d}let y=u(r.position),x=T(E(p,y),h),v=Math.max(x+f,.001*
f),w=Math.max(x-f,.001*v),M=(v+w)/(v-w),_=-2*v*w/(v-w);for(let S=0;S<3;S+=1)d[4*S+2]=h[S]*M,d[4*S+3]=h[S];return d[15]=-T(
h,y),d[14]=d[15]*M+_,d}function xn({center:a,frame:e},t,r,n,s){let[o,i]=t.axes,{height:c,state:l,aspect:h}=t,[u,m]=[k(o,
2*c*h/n),k(i,2*c/s)],p=A(A(E(l.focal_point,a),u,-n/2),m,-s/2);return{u_rayCorner:E(F(e,p),r),u_rayX:F(e,u),u_rayY:F(e,m)}}var ae=8,wn=9,ro=.2,no=1.4,vn=55,so=125,ao=.5,oo=4,Mn=4e-5,En=2e-6;function Sn(a,e,t,r,n){let s=Math.max(n-e,Math.min(e/
2,n),2)/a;if(t*(r+ae)<=s)return{scale:1,samples:r};let o=Math.min(wn,r),i=Math.sqrt(s/(o+ae)/t);return i<1?{scale:Math.max(
i,ro),samples:o}:{scale:1,samples:P(Math.floor(s/t-ae),o,r)}}function An(a,e,t,r,n){if(!n)return vn;let s=Math.min(wn,r),
o=e+a*t*ao**2*(s+ae);return P(o,vn,so)}function Tn(a,e,t,r){return Math.max(Math.floor(a/(e*t*(r+ae))),oo)}function _n(a){
return(2*a+ae)/(a+ae)}function Pn(a,e,t,r,n){let s=Math.max(e,.05)/(t*(r+ae)*n);return a+(s-a)*(s>a?.7:.3)}function Rn(a,e,t){
let[r,n,s]=[a.grain,a.spacing,a.samples].map(Number),o=Math.max(r*t,Math.min(r,1)),c=s*n*r*t/(e*o);return{u_grain:o,u_spacing:P(
c,.1,Math.max(no,n))}}var io=`#version 300 es
precision highp float;
precision highp int;
`,co=["flowtexPosition","flowtexCoordinate","flowtexNormal","flowtexScalar","flowtexCorners","flowtexRadius"],de=["u_sli\
ces","u_slicesNext","u_image","u_stepImage","u_cmap","u_shares","u_along","u_nodes","u_corners","u_open","u_places","u_d\
epths","u_colours","u_strides"],Se=class{graphics;entries=new Map;parallel=null;constructor(e){this.graphics=e}findFeatures(){
this.parallel=this.graphics.context.getExtension("KHR_parallel_shader_compile")}clear(){this.entries.clear()}dispose(){for(let e of this.
entries.values()){for(let t of e.shaders)this.graphics.free("Shader",t);this.graphics.free("Program",e.program)}this.clear()}get(e,t,...r){
let n=[e,t,...r].join("\0"),s=this.entries.get(n);return s||this.entries.set(n,s=this.build(e,t,r)),!s.ready&&!s.error&&
this.finish(s),s}build(e,t,r){let{graphics:n}=this,s=n.context,o=n.counted(s.createProgram()),i=[s.VERTEX_SHADER,s.FRAGMENT_SHADER],
c=io+r.map(u=>`#define ${u}
`).join(""),l=[e,t].map((u,m)=>{let p=n.counted(s.createShader(i[m]));return s.shaderSource(p,u.startsWith("#version")?u:
c+u),s.compileShader(p),s.attachShader(o,p),p});return co.forEach((u,m)=>s.bindAttribLocation(o,m,u)),s.linkProgram(o),{
program:o,shaders:l,uniforms:new Map,...{ready:!1,error:"",warm:!1,price:Mn}}}finish(e){let t=this.graphics.context,{program:r}=e,
n=this.parallel?.COMPLETION_STATUS_KHR;if(n&&!t.getProgramParameter(r,n))return;if(!t.getProgramParameter(r,t.LINK_STATUS)){
if(t.isContextLost())return;let i=[...e.shaders.map(c=>t.getShaderInfoLog(c)),t.getProgramInfoLog(r)].filter(Boolean).join(
`
`);e.error=i||"the driver gave no reason";return}for(let o of e.shaders)this.graphics.free("Shader",o);e.shaders=[];let s=t.
getProgramParameter(r,t.ACTIVE_UNIFORMS);for(let o=0;o<s;o+=1){let i=t.getActiveUniform(r,o),c=i&&t.getUniformLocation(r,
i.name);!i||!c||e.uniforms.set(i.name.replace(/\[0\]$/,""),{location:c,type:i.type})}t.useProgram(r),de.forEach((o,i)=>{
let c=e.uniforms.get(o);c&&c.type!==t.FLOAT_VEC2&&t.uniform1i(c.location,i)}),e.ready=!0}use(e,t){let r=this.graphics.context;
r.useProgram(e.program);for(let[n,s]of Object.entries(t)){let o=e.uniforms.get(n);if(!o)continue;let{location:i,type:c}=o,
l=typeof s=="object"?s:[Number(s)];c===r.FLOAT?r.uniform1fv(i,l):c===r.FLOAT_VEC2?r.uniform2fv(i,l):c===r.FLOAT_VEC3?r.uniform3fv(
i,l):c===r.FLOAT_VEC4?r.uniform4fv(i,l):c===r.FLOAT_MAT4?r.uniformMatrix4fv(i,!1,l):r.uniform1i(i,l[0])}}};var lo=4,ho=45,uo=[4,68],mo=Symbol.for("flowtex.gl/3");function Ln(a){return["EXT_color_buffer_float","EXT_color_buffer_\
half_float"].some(e=>a.getExtension(e)!==null)}var yr=class{canvas=document.createElement("canvas");gl;programs;users=new Set;waiting=new Set;common=new Map;stock=new Map;tracings=new Map;objects=0;isLost=!1;scheduled=0;picker=null;smooth=null;constructor(){
this.canvas.width=this.canvas.height=16;let e=this.canvas.getContext("webgl2",{alpha:!0,antialias:!1,powerPreference:"hi\
gh-performance"});this.gl=e&&Ln(e)?e:null,this.programs=new Se(this),this.gl&&this.programs.findFeatures(),this.canvas.addEventListener(
"webglcontextlost",t=>{t.preventDefault(),this.isLost=!0,this.objects=0,this.programs.clear(),this.common.clear(),this.tracings.
clear(),this.picker=this.smooth=null;for(let r of this.users)r.lost()}),this.canvas.addEventListener("webglcontextrestor\
ed",()=>{this.isLost=!1,this.gl&&Ln(this.gl)&&this.programs.findFeatures();for(let t of this.users)t.change()})}get context(){
if(!this.gl)throw new Error("WebGL2 is not available");return this.gl}leave(e){if(this.users.delete(e),this.waiting.delete(
e),!this.users.size){cancelAnimationFrame(this.scheduled),this.scheduled=0,this.programs.dispose();for(let t of[this.picker,
this.smooth])t&&this.freeTarget(t);this.picker=this.smooth=null,this.canvas.width=this.canvas.height=16}}request(e){this.
waiting.add(e),this.scheduled||=requestAnimationFrame(t=>this.run(t))}run(e){this.scheduled=0;let t=performance.now()+ho;
for(let r of[...this.waiting])if(this.waiting.delete(r),r.frame(e,t),performance.now()>t)break;this.waiting.size&&(this.
scheduled||=requestAnimationFrame(r=>this.run(r)))}counted(e){if(e===null)throw new Error("the graphics card has no memo\
ry left, or the context is lost");return this.objects+=1,e}free(e,t){if(t===null||this.isLost||!this.gl)return;this.objects-=
1,this.gl[`delete${e}`](t)}hold(e){if(!e.digest)return e;let t=this.stock.get(e.digest)??{part:e,users:0};return this.stock.
set(e.digest,{...t,users:t.users+1}),t.part}release(e){let t=e&&this.stock.get(e.digest);!e||!t||(t.users-=1,t.users||this.
stock.delete(e.digest))}target(e,t,r,n){let s=this.context,o=this.counted(s.createFramebuffer());s.bindFramebuffer(s.FRAMEBUFFER,
o);let c=[[e,s.COLOR_ATTACHMENT0],[s.DEPTH_COMPONENT24,s.DEPTH_ATTACHMENT]].map(([l,h])=>{let u=this.counted(s.createRenderbuffer());
return s.bindRenderbuffer(s.RENDERBUFFER,u),s.renderbufferStorageMultisample(s.RENDERBUFFER,n,l,t,r),s.framebufferRenderbuffer(
s.FRAMEBUFFER,h,s.RENDERBUFFER,u),u});return{frame:o,buffers:c}}freeTarget(e){this.free("Framebuffer",e.frame);for(let t of e.
buffers)this.free("Renderbuffer",t)}bindSmooth(e,t){let r=this.context,n=this.smooth;if(!n||n.width<e||n.height<t){let[s,
o]=[Math.max(e,n?.width??0),Math.max(t,n?.height??0)];n&&this.freeTarget(n);let i=this.target(r.RGBA8,s,o,lo);this.smooth=
{...i,width:s,height:o}}r.bindFramebuffer(r.FRAMEBUFFER,this.smooth?.frame??null)}copySmooth(e,t){let r=this.context;r.bindFramebuffer(
r.READ_FRAMEBUFFER,this.smooth?.frame??null),r.bindFramebuffer(r.DRAW_FRAMEBUFFER,null),r.disable(r.SCISSOR_TEST),r.blitFramebuffer(
0,0,e,t,0,0,e,t,r.COLOR_BUFFER_BIT,r.NEAREST),r.bindFramebuffer(r.FRAMEBUFFER,null)}numbers(e,t=1,r=1){let n=this.context;
this.picker??=this.target(n.RGBA32UI,...uo,0),n.bindFramebuffer(n.FRAMEBUFFER,this.picker.frame),n.viewport(0,0,t,r),n.disable(
n.SCISSOR_TEST),n.enable(n.DEPTH_TEST),n.clearBufferuiv(n.COLOR,0,[0,0,0,0]),n.clear(n.DEPTH_BUFFER_BIT),e();let s=new Uint32Array(
4*t*r);return n.readPixels(0,0,t,r,n.RGBA_INTEGER,n.UNSIGNED_INT,s),n.bindFramebuffer(n.FRAMEBUFFER,null),s}};function kn(){
let a=globalThis;return a[mo]??=new yr}var nt=class{size;poles;rays;nodes;isAlongJ;cells;lines;constructor(e,t,r){let[n,s]=t;this.poles=e,this.nodes=t,this.rays=
r,this.isAlongJ=e[0]?.component!==0,[this.lines,this.cells]=this.isAlongJ?[n,s-1]:[s,n-1];let o=e.reduce((i,c)=>i+this.depth(
c)+1,0);this.size={width:s+(this.isAlongJ?0:o),height:n+(this.isAlongJ?o:0)}}laidOut(e){if(!this.poles.length)return e;let[
t,r]=this.nodes,{width:n,height:s}=this.size,o=new Float32Array(4*n*s);for(let i=0;i<t;i+=1)o.set(e.subarray(4*r*i,4*r*(i+
1)),4*n*i);return this.poles.forEach((i,c)=>this.fill(o,i,c)),o}fastest(e){let t=0;for(let r=0;r<(this.isAlongJ?this.size.
height:this.size.width);r+=1){let n=s=>(r-s.line)*s.inward<s.near;if(!(r<this.lines&&this.poles.some(n)))for(let s=0;s<=
this.cells;s+=1){let o=this.at(r,s);t=Math.max(t,Math.abs(e[o]),Math.abs(e[o+1]))}}return t}at(e,t){return 4*(this.isAlongJ?
e*this.size.width+t:t*this.size.width+e)}depth({near:e}){return Math.min(e+3,this.lines-1)}shift(e){let t=this.poles.slice(
0,e).reduce((s,o)=>s+this.depth(o)+1,0),{inward:r,line:n}=this.poles[e];return this.lines+t-(r>0?n:n-this.depth(this.poles[e]))}ray(e,t){
let r=2*(e*(this.cells+1)+t);return[this.rays[r],this.rays[r+1]]}fill(e,t,r){let{cells:n}=this,{line:s,inward:o,component:i}=t,
[c,l]=[this.shift(r),this.still(e,t,r)];for(let h=0;h<=this.depth(t);h+=1)for(let u=0;u<=n;u+=1){let m=this.at(s+o*h,u),
p=this.at(s+o*h+c,u),[f,d]=[e[m+1-i],e[m+i]],[g,b,y]=[u,(u+1)%n,(u+n-1)%n].map(x=>this.ray(r,x));for(let x of[0,1]){let v=(b[x]-
y[x])/2;e[p+x]=h?o*d*g[x]+f*h*v:l[x]}e.copyWithin(p+2,m+2,m+4)}}still(e,{line:t,inward:r,component:n},s){let[o,i,c,l,h]=[
0,0,0,0,0];for(let m=0;m<this.cells;m+=1){let[p,f]=this.ray(s,m),d=p*p+f*f,g=e[this.at(t,m)+n]*r;[l,h]=[l+g*p,h+g*f],[o,
i,c]=[o+p*p/d,i+p*f/d,c+f*f/d]}let u=o*c-i*i;return[(c*l-i*h)/u,(o*h-i*l)/u]}get raysSize(){return[this.cells+1,Math.max(
this.poles.length,1)]}get angles(){let{cells:e}=this,[t,r]=this.raysSize,n=new Float32Array(4*t*r);return this.poles.forEach(
(s,o)=>{let i=[];for(let c=0;c<=e;c+=1){let[l,h]=this.ray(o,c),u=Math.atan2(h,l);for(;u<i[c-1];)u+=2*Math.PI;i.push(u)}i.
forEach((c,l)=>{let h=i[0]+2*Math.PI*l/e+1e-6,u=i.findLastIndex(m=>m<=h);n.set([c,Math.hypot(...this.ray(o,l)),u],4*(o*t+
l))})}),n}get uniforms(){let e=this.poles.flatMap(({line:r,inward:n,near:s},o)=>[r,n,s,this.shift(o)]),t=this.poles.flatMap(
({plane:r})=>r);for(;e.length<8;)e.push(0);for(;t.length<12;)t.push(0);return{u_poles:e,u_planes:t,u_polar:Number(this.isAlongJ)}}};var On=32767,[po,fo,go,bo]=[0,1,2,3],yo=2,xo=8,vo=4,wo=4,Mo=64,Eo=64,So=2e4,Ao=1e30,Fn=1e-5;function Nn(a,e,t){let[r,n]=t,
s=a.shape[1],[o,i]=e.drawn,c=new Float64Array(r*n*3);for(let l=0,h=0;l<r;l+=1){let u=3*((l+o+1)*s+i+1);for(let m=0;m<3*n;m+=
1)c[h++]=a.data[u+m]+e.middle[m%3]}return{data:c,shape:[r,n,3]}}function In(a,e,t){let[r,n]=t,s=3*a.shape[1],[o,i]=e.drawn,
c=new Int16Array(r*n*3);for(let l=0,h=0;l<r;l+=1)for(let u=0;u<n;u+=1,h+=3){let m=s*(l+o+1)+3*(u+i+1),p=g=>[0,1,2].map(b=>a.
data[m+g+b]-a.data[m-g+b]),f=N(p(3),p(s)),d=O(f)||1;for(let g=0;g<3;g+=1)c[h+g]=Math.round(f[g]/d*On)}for(let{component:l,
line:h,inward:u}of e.poles??[]){let[m,p]=l?[h-o,n]:[h-i,r];if(m<0||m>=(l?r:n))continue;let f=(y,x)=>3*(l?y*n+x:x*n+y),d=[
0,0,0];for(let y=0;y<p;y+=1)for(let x=0;x<3;x+=1)d[x]+=c[f(m+u,y)+x];let g=O(d)||1,b=d.map(y=>Math.round(y/g*On));for(let y=0;y<
p;y+=1)c.set(b,f(m,y))}return{data:c,shape:[r,n,3]}}function oe({slices:a},e){let{trace:t,times:r,lags:n}=a;if(!t?.pathlines||
!t.timed)return[e];let s=n[n.length-1]*t.timed.unit,o=r.map(c=>Math.abs(c-r[e])<s),i=c=>o[c]||o[c-1]||o[c+1];return[...r.
keys()].filter(i)}function To({slices:a},e,t,r,n){let{trace:s,times:o}=a;if(!s?.pathlines||!s.timed)return[{from:r,to:n,
steps:[e,e],between:[0,1]}];let i=[],{unit:c}=s.timed,l=h=>t*(o[h]-o[e])/c;for(let h=e;r<n;h+=t){let u=!(h+t in o),m=u?n:
l(h+t);if(m<=r+Fn*n)continue;let p=u?[0,1]:[l(h),m],f=m>=n-Fn*n;i.push({from:r,to:f?n:m,steps:[h,u?h:h+t],between:p}),r=
f?n:m}return i}function st({programs:a},e,t){let{fullVertex:r,trace:n="",layers:s=""}=e.shaders,o=(c,...l)=>{let h=l.filter(
m=>typeof m=="string"),u=a.get(r,c,...h);if(u.error)throw new Error(`the tracer cannot be built: ${u.error}`);return u},
i=t.poles!==void 0&&"FLOWTEX_POLES";return{follow:o(n,i,t.pathlines&&"FLOWTEX_PATHLINES"),compose:t.pathlines?null:o(n,i,
"FLOWTEX_COMPOSED"),slopes:o(s,"FLOWTEX_SLOPES"),tangents:o(s,i)}}var at=class{graphics;header;trace;find;textures=new Set;frames=[];result=null;passes;flows=new Map;fastest=1;poles;constructor(e,t,r,n,s){
this.graphics=e,this.header=t,this.trace=r,this.find=n,this.poles=new nt(r.poles??[],r.nodes,n("rays")?.data??[]),this.passes=
this.slices(s)}advance(e){if(!Object.values(st(this.graphics,this.header,this.trace)).every(r=>r?.ready??!0))return null;
let t=this.graphics.context;try{do{let{done:r,value:n}=this.passes.next();if(t.isContextLost())return null;if(r)return this.
result=null,n}while(performance.now()<e);return null}finally{this.unbind()}}dispose(){for(let e of this.textures)this.graphics.
free("Texture",e);for(let e of this.frames)this.graphics.free("Framebuffer",e);this.result&&!this.graphics.context.isContextLost()&&
this.graphics.context.deleteTexture(this.result),this.result=null,this.textures.clear(),this.frames.length=0}data(e){let t=this.
find(e);if(!t)throw new Error(`the part "${e}" of the scene is missing`);return t.data}numbers(e){let t=this.data(e);return t instanceof
Float32Array?t:new Float32Array(t).map(r=>Re[r])}texture(e,t,r,n){let s=this.graphics.context,o=this.graphics.counted(s.
createTexture());return this.textures.add(o),s.activeTexture(s.TEXTURE0),s.bindTexture(s.TEXTURE_2D,o),s.texStorage2D(s.
TEXTURE_2D,1,r,e,t),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MIN_FILTER,s.NEAREST),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MAG_FILTER,
s.NEAREST),n&&s.texSubImage2D(s.TEXTURE_2D,0,0,0,e,t,s.RGBA,s.FLOAT,n),o}frame(){let e=this.graphics.context,t=this.graphics.
counted(e.createFramebuffer());return this.frames.push(t),e.bindFramebuffer(e.FRAMEBUFFER,t),t}target(e,t){let r=this.graphics.
context,n=this.texture(e,t,r.RGBA32UI,null),s=this.frame();return r.framebufferTexture2D(r.FRAMEBUFFER,r.COLOR_ATTACHMENT0,
r.TEXTURE_2D,n,0),[n,s]}unbind(){let e=this.graphics.context;for(let t=0;t<xo;t+=1)e.activeTexture(e.TEXTURE0+t),e.bindTexture(
e.TEXTURE_2D,null),e.bindTexture(e.TEXTURE_2D_ARRAY,null);e.bindFramebuffer(e.FRAMEBUFFER,null)}flow(e){let{trace:t}=this,
r=this.numbers(`flow/${e}`),n=this.data("unit"),s=r.length/n.length,o=new Float32Array(4*n.length);for(let c=0,l=0;c<n.length;c+=
1,l+=s){let h=r[l+2],u=Re[n[c]]*t.unit;o[4*c]=r[l]*h/u,o[4*c+1]=r[l+1]*h/u,o[4*c+2]=h,o[4*c+3]=t.timed?t.timed.unit:u}let i=this.
poles.laidOut(o);return t.timed&&(this.fastest=Math.max(this.fastest,this.poles.fastest(i)*t.timed.speed*t.timed.unit)),
i}wholeSpeed(e){let t=this.numbers(`flow/${e}`),r=this.data("unit").length,n=t.length/r,s=Number(this.trace.uncertain??!1),
o=new Float32Array(4*r);for(let i=0;i<r;i+=1)o[4*i]=t[(i+1)*n-1-s],o[4*i+1]=s*t[(i+1)*n-1];return o}cells(){let[e,t]=this.
trace.nodes,[r,n]=["open","nearest"].map(o=>this.find(o)?.data),s=new Float32Array(4*e*t);for(let o=0;o<e*t;o+=1){s[4*o]=
r?r[o]:1;for(let i of[0,1])s[4*o+1+i]=n?n[2*o+i]:0}return s}padded(){let e=this.data("padded"),t=new Float32Array(e.length/
3*4);for(let r=0;r<e.length/3;r+=1)for(let n=0;n<3;n+=1)t[4*r+n]=e[3*r+n];return t}flowTexture(e){let{width:t,height:r}=this.
poles.size,n=this.graphics.context,o=this.flows.get(e)??this.texture(t,r,n.RGBA32F,this.flow(e));this.flows.delete(e),this.
flows.set(e,o);for(let[i,c]of this.flows){if(this.flows.size<=wo)break;this.flows.delete(i),this.textures.delete(c),this.
graphics.free("Texture",c)}return o}partsOf({from:e,to:t}){let r=P(Math.ceil((t-e)*this.fastest/Mo),1,Eo),n=s=>s===r?t:e+
(t-e)*s/r;return Array.from({length:r},(s,o)=>[n(o),n(o+1)])}*slices(e){let{graphics:t,trace:r,header:n}=this,s=t.context,
{geometry:o,slices:i}=n,[c,l]=r.nodes,[h,u]=[o.rows.size,o.columns.size],m={width:u,height:h,layers:i.count,channels:4,levels:o.
levels},p=s.createTexture();this.result=p,s.activeTexture(s.TEXTURE0),Qe(s,p,m);let{poles:f}=this,d=this.texture(f.size.
width,f.size.height,s.RGBA32F,this.flow(e)),g=this.texture(...f.raysSize,s.RGBA32F,f.angles),b=[this.texture(l,c,s.RGBA32F,
this.cells()),this.texture(l+2,c+2,s.RGBA32F,this.padded()),this.texture(l,c,s.RGBA32F,this.wholeSpeed(e))],y=[0,1,2,3,4].
map(()=>this.target(l,c)),{lags:x,sides:v,count:w}=i,M={u_flow:0,u_cells:1,u_padded:2,u_speed:3,u_before:4,u_last:5,u_earlier:5,
u_flowNext:6,u_rays:7,...f.uniforms,u_longest:r.longest??Ao,u_nodes:[l,c],u_closed:[Number(r.closed[1]),Number(r.closed[0])],
u_first:[r.first[1],r.first[0]],u_texels:[u,h],u_offsetJ:r.offset.slice(0,3),u_offsetI:r.offset.slice(3,6),u_timed:r.timed?.
speed??0,u_rest:r.rest,u_pace:r.pace,u_unit:i.unit,u_cell:i.cell/i.unit,u_planar:Number(o.planar),u_mostReach:2*x[x.length-
1]},_=([U,Z],we,he,Pe)=>{s.viewport(0,0,U,Z);for(let Y of[s.SCISSOR_TEST,s.DEPTH_TEST,s.BLEND,s.CULL_FACE])s.disable(Y);
we.forEach((Y,ee)=>{s.activeTexture(s.TEXTURE0+ee),s.bindTexture(s.TEXTURE_2D,Y)}),s.bindVertexArray(null),t.programs.use(
he,{...M,...Pe}),s.drawArrays(s.TRIANGLES,0,3)},S=this.frame(),R=(U,Z,we,he)=>{s.bindFramebuffer(s.FRAMEBUFFER,S),s.framebufferTextureLayer(
s.FRAMEBUFFER,s.COLOR_ATTACHMENT0,p,0,U),_([u,h],[d,...b,...we],Z,he)},{follow:L,compose:V,slopes:I,tangents:J}=st(t,n,r);
R(0,J,[],{u_inCells:0}),w>1+v*x.length&&R(w-1,J,[],{u_inCells:1});let se=0;for(let U=0;U<v;U+=1){let Z=U?1:-1,we=1+U*x.length,
[he,Pe,Y]=[y[0],y[0],y[0]];for(let[ee,Je]of x.entries()){let[zr,Gr]=[x[ee-1]??0,x[ee-2]??0],Wr=Je>vo&&Gr>0?V:null,Ze=Y;for(let lr of To(
n,e,Z,zr,Je)){let[Ha,za]=lr.steps.map(hr=>this.flowTexture(hr)),Ga=Wr?[[zr,Je]]:this.partsOf(lr);for(let[hr,Wa]of Ga){let $r=y.
find($a=>![he,Pe,Y,Ze].includes($a))??y[0];s.bindFramebuffer(s.FRAMEBUFFER,$r[1]),_([l,c],[Ha,...b,Ze[0],Pe[0],za,g],Wr??
L,{u_lagEarlier:Gr,u_from:hr,u_to:Wa,u_side:Z,u_between:lr.between}),Ze=$r,!((se+=c*l)<So)&&(s.readPixels(0,0,1,1,s.RGBA_INTEGER,
s.UNSIGNED_INT,new Uint32Array(4)),se=0,yield)}}[Pe,Y]=[Y,Ze],ee||(he=Y);let Da=r.uncertain&&ee===yo,Ba=ee===1&&!U?fo:Da?
bo:po;ee&&R(we+ee,I,[Y[0],Y[0]],{u_fourth:Ba,u_lag:Z*Je})}R(we,I,[he[0],Y[0]],{u_fourth:go,u_lag:Z*x[0]})}return s.activeTexture(
s.TEXTURE0),s.bindTexture(s.TEXTURE_2D_ARRAY,p),m.levels&&s.generateMipmap(s.TEXTURE_2D_ARRAY),p}};var _o={slices:[12,4],flow:[100,24]},Po=24,ot=class{all=new Map;graphics;constructor(e){this.graphics=e}set(e){let{name:t,
digest:r}=e;if(r&&this.all.get(t)?.digest===r)return!1;let n=this.graphics.hold(e);return this.remove(t),this.all.set(t,
n),!0}remove(e){this.graphics.release(this.all.get(e)),this.all.delete(e)}clear(e=()=>!0){for(let t of[...this.all.keys()])
e(t)&&this.remove(t)}trim(e,t,r){let{hasSteps:n=!1,hasMarks:s=!1,memory:o=0}=t??{};if(!e||!n)return;for(let h of s?Object.
keys(Me):[]){let u=[...this.all.keys()].filter(m=>m.startsWith(`${h}/`));for(let m of u.slice(0,-Po))r.includes(X(m))||this.
remove(m)}let i=e.slices.trace?"flow":"slices",c=h=>[...this.all.keys()].filter(u=>u.startsWith(h)),l=r.flatMap(h=>oe(e,
h));for(let h of c(`${i}/`).slice(0,-_o[i][+(o>0)])){let u=X(h);if(l.includes(u))continue;for(let p of[i,"extra"])this.remove(
`${p}/${u}`);let m=o?c("scalars/"):[];for(let p of m)Ee(p,u,e)&&this.remove(p)}}};var it=class{controller=new AbortController;observers=new Set;timers=new Set;globalListeners=0;get isOver(){return this.
controller.signal.aborted}listen(e,t,r,n={}){(e===document||e===window)&&(this.globalListeners+=1);let{signal:s}=this.controller;
e.addEventListener(t,r,{...n,signal:s})}later(e,t){let r=setTimeout(()=>{this.timers.delete(r),e()},t);return this.timers.
add(r),r}cancel(e){e!==null&&(clearTimeout(e),this.timers.delete(e))}observe(e,t){e.observe(t),this.observers.add(e)}watch(e,t,r){
e.observe(t,r),this.observers.add(e)}stats(){let{globalListeners:e,observers:t,timers:r}=this;return{listeners:e,observers:t.
size,timers:r.size}}end(){this.controller.abort(),this.globalListeners=0;for(let e of this.observers)e.disconnect();this.
observers.clear();for(let e of this.timers)clearTimeout(e);this.timers.clear()}};function Cn(a,e,t){let{geometry:r,slices:n,constants:s}=a,o=e,i=ue(a),c=2**(Math.floor(Math.log2(r.extent))-s.noiseDoublings),
l=t.eye[3],h=F(r.frame,E(t.eye,k(r.center,l))),u=Vn(a,e),m=u?"ramp":o.kernel,p=i&&m==="ramp"?"hann":m;return{u_eye:[...E(
h,k(t.anchor,l)),l],u_between:t.between,u_slicesSize:[r.columns.size,r.rows.size],u_deepest:r.levels,u_lags:n.lags,u_lagCount:n.
lags.length,u_sides:o.two_sided||i||u?n.sides:1,u_unit:n.unit,u_rateLayer:n.count-1,u_cell:n.cell,u_samples:ct(a,e,t.still)?
2*o.samples-1:o.samples,u_spacing:o.spacing,u_grain:o.grain*t.density,u_kernel:s.kernels.indexOf(p),u_lod:o.lod,u_contrast:o.
contrast,u_strength:o.strength,u_fade:i?0:o.fade,u_seed:o.seed,u_showLevel:o.show_level,u_fixed:o.fixed_grain,...Ro(a,o,
t),...Lo(a,t,c),...ko(a,t,c),u_noiseFinest:c,u_texel:r.extent/o.resolution,u_apart:xr(a,e)*t.density,u_bySpeed:e.arrow_length===
"speed",u_arrowSides:n.sides,u_pieces:s.arrows.pieces,...a.image?Oo(a.image,o.tiles,t.density):{}}}function ct(a,e,t=!1){
let r=e.motion!=="off"&&!ue(a);return!a.image&&(r||a.slices.steps>1&&!t)}function Vn(a,e){return!a.image&&e.texture==="s\
treaklets"}function Le(a,e){return Number(e.arrows)>0&&!ue(a)&&!a.image}function xr({constants:a},{arrows:e}){return a.arrows.
least*Math.max(Number(e),a.arrows.mostDense)}function lt(a,e,t){let{geometry:r,slices:n,constants:s}=a,o=e,i=Math.hypot(
...E(t.eye,r.center))-.5*r.extent,c=t.eye[3]?Math.max(i,0)/Math.hypot(...E(t.eye,t.focus)):1,l=o.lod?t.pixel*c*o.grain*t.
density:r.extent/o.resolution;return Math.floor(o.samples/2)*o.spacing*l<s.farCells*n.critical}function Un(a,e,t,r){let n={
FLOWTEX_CELLS:t,FLOWTEX_MOVING:ct(a,e,r),FLOWTEX_SPARSE:Vn(a,e),FLOWTEX_REPEATED:!!a.ends};return Object.entries(n).flatMap(
([s,o])=>o?[s]:[])}function Ro(a,e,t){let{geometry:r,constants:n}=a,{times:s,pace:o}=a.slices,i=s.length>1,c=!i&&e.speed_in===
"pixels",l=s[s.length-1]-s[0],h=l*o/r.extent,u=i?l/(Math.round(h)||h):e.period,m=(i?t.time-s[0]:t.clock)/u%n.mostTurns,p=u*
(i?o:e.speed),f=m%n.clockStep;return{u_clock:[m-f,f],u_travel:p*(c?t.density:1),u_travelInPixels:c,u_travelBySpeed:i||e.
motion==="speed",u_wave:n.wavePixels*t.density}}function Lo(a,e,t){let{noiseDoublings:r,clearDoublings:n}=a.constants,{frame:s,
center:o}=a.geometry,i=F(s,E(e.focus,o)),c=2**(r-n)-1,l=2**n,h=i.map(p=>P(Math.round(p/t/l),-c,c)*l),u=h.map(p=>p/Math.SQRT2),
m=u.map(p=>Math.floor(p/l)*l);return{u_noiseOrigin:h.map((p,f)=>p*t-e.anchor[f]),u_noiseOriginEven:h,u_noiseOriginOdd:m,
u_noiseRestOdd:u.map((p,f)=>p-m[f])}}function ko(a,e,t){let{ends:r,geometry:n,constants:s}=a;if(!r)return{};let{frame:o,
center:i}=n,c=F(o,[1,0,0]),[l,h]=r.map(g=>g-i[0]-T(c,e.anchor)),u=2**s.clearDoublings,m=k(c,(r[1]-r[0])/t),p=k(m,Math.SQRT1_2),
f=g=>g.map(b=>Math.floor(b/u)*u),d=g=>g.map(b=>b-Math.floor(b/u)*u);return{u_ends:[c[0],c[1],l,h],u_turnEven:f(m),u_turnRestEven:d(
m),u_turnOdd:f(p),u_turnRestOdd:d(p)}}function Oo({size:a,stepSize:e,repeat:t},r,n){return{u_stepSize:e.map(s=>s*n),u_imageSize:a.
map(s=>s*n*r),u_imageRound:[Number(t[1]),Number(t[0])],u_tiles:r}}function vr(a,e){if(a.length<2)return[0,0,0];let t=0;for(;t<
a.length-2&&a[t+1]<=e;)t+=1;let r=(e-a[t])/(a[t+1]-a[t]);return[t,t+1,P(r,0,1)]}var Fo=.5,No=6,Io=60,Co=.5,ht=class{time=0;clock=0;playing=!1;pace=1;times=[0];lastFrame=0;hasHeader=!1;setHeader(e){let{
times:t}=e.slices;(!(t.length===this.times.length&&t.every((n,s)=>n===this.times[s]))||!this.hasHeader)&&(this.time=e.time,
this.clock=e.clock),this.hasHeader=!0,this.times=t}get varies(){return this.times.length>1}get span(){return[this.times[0],
this.times[this.times.length-1]]}get moment(){return vr(this.times,this.time)}timeOf([e,t,r]){return this.times[e]+r*(this.
times[t]-this.times[e])}seek(e){this.time=P(e,...this.span)}stepFrom(e){let{times:t,time:r}=this,n=t.findIndex(i=>e>0?i>
r:i>=r),s=t.length,o=n<0?s:n;return t[(e>0?o:o-1+s)%s]}start(){this.playing=!0,this.lastFrame=0}range(e){if(this.varies)
return{first:this.span[0],last:this.span[1],now:this.time};let t=Number(e.period);return{first:0,last:t,now:this.clock%t}}advance(e,t){
let r=this.lastFrame?Math.min((e-this.lastFrame)/1e3,Co)*this.pace:0;if(this.lastFrame=e,!this.varies)return this.clock+=
r,!0;let[n,s]=this.span,o=P(Fo*(this.times.length-1),No,Io),i=this.time+r*(s-n)/o,[c,l]=vr(this.times,Math.min(i,s));return t(
[c,l])?(this.time=i>s?n:i,!0):!1}};var Dn=()=>null,ut=class{};var B="",Bn=5,G=a=>a.join("/"),ie=a=>a.split("/").map(Number);function Hn(a,e){let[t,r,n]=["samples","spacing","grain"].
map(o=>Number(e[o])),s=.5*t*r*n;return a.cellPixels*Math.max(1,2*s/(a.cellPixels*a.pathCells))}var mt=class{header;place;constructor(e,t){
this.header=e;let r=0,n=e.blocks.map(([s,o])=>(r+=s*o)-s*o);this.place=typeof t=="function"?t:(s,o,i)=>{let c=Bn*(n[s]+o*
e.blocks[s][1]+i);return t.subarray(c,c+Bn)}}blocksOf(e,[t,r,n]){let[s,o]=this.header.blocks[t];if(e===B)return[0,0,s,o];
let{tileBlocks:i}=this.header,c=[Math.min(i*(r+1),s),Math.min(i*(n+1),o)];return[i*r,i*n,...c]}children(e,[t,r,n]){let{blocks:s,
tileBlocks:o}=this.header,i=s[t-1].map(u=>Math.ceil(u/o)),[c,l]=e===B?[[0,0],i]:[[2*r,2*n],[r,n].map((u,m)=>Math.min(2*u+
2,i[m]))],h=[];for(let u=c[0];u<l[0];u+=1)for(let m=c[1];m<l[1];m+=1)h.push([t-1,u,m]);return h}finerPart([,e,t],r){let{
tileBlocks:n}=this.header,s=n/2,[,o,i]=r===B?[0,0,0]:ie(r);return[s*e-n*o,s*t-n*i,s]}choose(e){let t=new Map,{depth:r,finest:n}=this.
header,s=[B];for(let o of s){let i=o===B?[r,0,0]:ie(o),c={key:i,needed:!1,pixels:0,finer:[]},[l,h,u,m]=this.blocksOf(o,i),
p=this.header.blocks[i[0]][1],f=new Set;for(let d=l;d<u;d+=1)for(let g=h;g<m;g+=1){let b=this.place(i[0],d,g);if(!wr(e,b)||
e.shownOn?.sees(b)===!1)continue;let y=Mr(e,b)*(e.shownOn?.scale(b)??1);i[0]>n&&y>e.cellPixels?f.add(d*p+g):c.needed=!0,
f.has(d*p+g)||(c.pixels=Math.max(c.pixels,y))}f.size&&(c.finer=this.children(o,i).filter(d=>{let[g,b,y]=this.finerPart(d,
B);return[...f].some(x=>{let[v,w]=[Math.floor(x/p)-g,x%p-b];return v>=0&&v<y&&w>=0&&w<y})}).map(G)),t.set(o,c),s.push(...c.
finer)}return t}};function wr({planes:a},[e,t,r,n]){return a.every(s=>T(s,[e,t,r])+s[3]>=-n*O(s.slice(0,3)))}function Mr({
eye:a,halfHeight:e,pixels:t},[r,n,s,o,i]){let c=a?Math.max(O(E([r,n,s],a))-o,i):1;return i*.5*t/(e*c)}function zn(a){return[
...a].filter(([t,{needed:r}])=>t!==B&&r).sort(([,t],[,r])=>r.pixels-t.pixels).map(([t])=>t)}function Er(a,e){let t=new Map,
r=s=>{t.delete(s),a.get(s)?.finer.forEach(r)},n=s=>{let{needed:o=!1,finer:i=[]}=a.get(s)??{},c=i.filter(n);return s!==B&&
!o&&c.length===i.length?!0:s!==B&&!e(s)?(c.forEach(r),!1):(t.set(s,c),!0)};return n(B),t}function pt(a,e,t){let r=s=>Math.
min(s*2**e,t-1),n=Math.floor(a);return r(n)+(a-n)*(r(n+1)-r(n))}function Gn(a,e,t){let r=2**e,n=Math.max(Math.min(Math.floor(
a/r),Math.ceil((t-1)/r)-1),0);return n+(a-n*r)/(Math.min((n+1)*r,t-1)-n*r)}var Wn=1e4,Vo=20,Uo=4,Do=4,Bo="The surface is shown coarse",Ho="A part of the surface is shown coarse",zo="A time step c\
annot be shown",Ae=class{times=new Map;now;constructor(e=()=>performance.now()){this.now=e}add(e){this.times.set(e,this.
now())}has(e){return this.now()-(this.times.get(e)??-1/0)<Wn}},ke=class{source;taker;running=new Map;jobs=[];failed=new Ae;constructor(e,t){
this.source=e,this.taker=t}want(e){this.jobs=e;let t=new Set(e.map(String));for(let[r,n]of this.running)t.has(r)||(this.
running.delete(r),n.abort());this.next()}stop(){this.want([]),this.failed=new Ae}next(){for(let e of this.jobs){if(this.
running.size>=(this.source()?.atOnce??Uo))return;!this.running.has(String(e))&&!this.failed.has(String(e))&&this.run(e)}}async run(e){
let{taker:t}=this,r=this.source();if(!r)return;let[n,s,o]=e,i=new AbortController,{signal:c}=i,l=h=>n?t.tiles?.has(G(n),
h)??!1:t.parts.has(h);this.running.set(String(e),i);try{let h=await r.load(n,s,c,l,o);if(!c.aborted)for(let u of h)t.setPart(
u)}catch(h){c.aborted||this.fail(e,h)}c.aborted||(this.running.delete(String(e)),this.failed.has(String(e))||(this.jobs=
this.jobs.filter(h=>String(h)!==String(e))),this.next())}fail(e,t){let[r,n]=e;this.failed.add(String(e)),setTimeout(()=>this.
next(),Wn+Vo);let s=t.fault==="unreachable",o=r&&!s?G(r):void 0;this.taker.lack($n(r?Ho:zo,t),o,n)}};function $n(a,e){let{
fault:t,message:r=String(e),detail:n=""}=e;return console.warn(r,n),t==="other"?r:`${a}: ${r}`}var ft=class{tiles;wholes;marks;given;formula=null;constructor(e,t){
this.given=e,this.tiles=new ke(()=>this.source,t),this.wholes=new ke(()=>this.source,t),this.marks=new ke(()=>this.source,
t)}get source(){return this.formula??this.given}get hasSteps(){return this.source?.hasSteps??!1}get hasMarks(){return this.
source?.hasMarks??!1}setHeader(e){this.stop(),this.formula=e.formula?new ut(e,e.formula):null}follow(e){return this.formula?.
follow(e)??!1}fit(){return this.formula?.fit()??!1}trajectory(e){return this.formula?.trajectory(e)??null}open(){let{taker:e}=this.
tiles;this.source?.open?.().catch(t=>e.lack($n(Bo,t)))}wantTiles(e,t){this.tiles.want(e.map(r=>[r,t]))}wantSteps(e){let t=this.
wholes.jobs.flatMap(([,n])=>n);if(e.every(n=>t.includes(n)))return;let r=[...new Set([...e,...t])].slice(0,e.length+Do);
this.wholes.want(r.map(n=>[null,[n]]))}wantMarks(e){let t=e.map(([r,n])=>[null,[n],r]);String(t)!==String(this.marks.jobs)&&
this.marks.want(t)}stop(){this.tiles.stop(),this.wholes.stop(),this.marks.stop()}};function jn({header:a,camera:e,anchor:t,player:r,rows:n},s,o){let{geometry:i,constants:c}=a,l=e.state.focal_point,h=F(i.
frame,E(l,i.center)),u=c.anchorRange*2*e.height,m=p=>p.some(f=>Math.abs(f)>u);return{focus:l,anchor:m(E(h,t))?m(h)?h:[0,
0,0]:t,eye:e.eye,between:s[2],time:r.timeOf(s),clock:r.clock,still:!r.playing,density:o,pixel:2*e.height/Math.max(n*o,1)}}var Go=-1e9,Yn=500;function dt(a,e){if(a instanceof Float32Array&&!e.some(Boolean))return a;let t=new Float32Array(a.length);
for(let r=0;r<a.length;r+=1)t[r]=a[r]-e[r%3];return t}function Xn({shape:a,rows:e,columns:t}){return Float32Array.from({
length:2*a[0]*a[1]},(r,n)=>{let[s,{before:o,size:i}]=n%2?[Math.floor((n>>1)/a[1]),e]:[(n>>1)%a[1],t];return(s+o+.5)/i})}
function qn(a,e){let t=Math.max(a.length,e.length);return Float32Array.from({length:2*t},(r,n)=>(n%2?e:a)[n>>1]??0)}function Kn(a){
let e=Float32Array.from(a);for(let t=0;t<a.length;t+=3){let r=Math.hypot(a[t],a[t+1],a[t+2])||1;for(let n=t;n<t+3;n+=1)e[n]/=
r}return e}function gt(a,e){let t=a[0]?.length??0,r=new Float32Array(2*t),n=mr(e);return a.forEach((s,o)=>{for(let i=0;i<
t;i+=1){let c=n(s[i]);r[2*i+o]=Number.isFinite(c)?P(c,-Yn,Yn):Go}}),r}function Jn([a,e],[t,r]){let[n,s]=[Math.min(Math.floor(
t),e-2),Math.min(Math.floor(r),a-2)],[o,i]=[t-n,r-s],c=s*e+n,[l,h]=[Math.min(o,i),Math.max(o,i)],u=c+(o>=i?1:e);return[[
c,1-h],[u,h-l],[c+e+1,l]]}function bt(a,e){return a.reduce((t,[r,n])=>t+n*e(r),0)}var Wo=1-1e-7;function Zn(a,e){return Uint32Array.
from({length:4*e.length},(t,r)=>r%4<3?a[3*(r>>2)+r%4]:e[r>>2])}function Oe(a,e,t){return[t,a+Math.min(Math.max(e,0),Wo)]}
function Qn(a,[e,t]){let r=Math.floor(t),[n,s]=[t-r,e];return[1-n-s,n,s].map((o,i)=>[a[3*r+i],o])}var es=180/Math.PI;var $o=1e-4;function jo(a){let[e,t,r]=[a-1,a-2,a-3];return[-(e*t*r)/6,a*t*r/2,-(a*e*r)/2,a*e*t/6]}function ts(a,e){let t=a*(e-1),r=P(
Math.floor(t)-1,0,e-4);return[r,jo(t-r)]}function Sr([a,e,t,r],{data:n,shape:s},o){let[i,c]=s,[l,h]=ts((o[0]-a)/(t-a),c),
[u,m]=ts((o[1]-e)/(r-e),i),p=[0,0,0];return m.forEach((f,d)=>{h.forEach((g,b)=>{for(let y=0;y<3;y+=1)p[y]+=g*f*n[3*((u+d)*
c+l+b)+y]})}),p}function yt(a,e,t){if(a.map&&!t)return null;let[r,n,s]=a.map&&t?Sr(a.map,t,e):e,o=[Math.atan2(n,r),Math.
atan2(s,Math.hypot(r,n))];return o.every(Number.isFinite)?[o[0]*es,o[1]*es]:null}function rs(a,e,t,r){let[n,s]=[e,t];if(a.
map&&r){let{map:p,radius:f}=a,d=$o*(p[2]-p[0])/(Math.hypot(...t)||1),[g,b]=[-d,d].map(y=>Sr(p,r,e.map((x,v)=>x+y*t[v])));
n=Sr(p,r,e),s=b.map((y,x)=>f*(y-g[x])/(2*d))}let[o,i,c]=n,[l,h]=[Math.hypot(o,i)||1,Math.hypot(o,i,c)||1],u=(o*s[1]-i*s[0])/
l,m=(o*s[0]+i*s[1])/l;return[u,(l*s[2]-c*m)/h]}var is=2,ns=8,Yo=4,Xo=10,cs=.05,ls=.25,ss=4,qo=.01,hs=1e-6,Ko=.001;function Jo({scene:a,place:e},[t,r]){let{rows:n,columns:s,
triangles:o}=a.header.geometry;if(o){let p=[-t-r,t,r];return a.cornersAt(e).map(([f,d],g)=>[f,d+p[g]])}let[i,c]=[e[0]+t+
s.before,e[1]+r+n.before],[l,h]=[Math.floor(i),Math.floor(c)],[u,m]=[i-l,c-h];return[(1-u)*(1-m),u*(1-m),(1-u)*m,u*m].map(
(p,f)=>{let d=P(l+(f&1),0,s.size-1);return[P(h+(f>>1),0,n.size-1)*s.size+d,p]})}function Ar(a,e=[0,0]){let{scene:t,moment:r}=a,
{slices:n}=t.header,s=Jo(a,e),[o,i,c]=r,l=s.map(([p])=>p),h=(o===i?[o]:[o,i]).map(p=>t.texels(p,l)),u=o===i?[1]:[1-c,c],
m=ue(t.header)?Zo(s.map((p,f)=>h[0](0,f))):s.map(()=>1);return p=>{let f=[0,0,0,0];return s.forEach(([,d],g)=>{let b=p+(p>
n.lags.length?-1:1)*n.lags.length,y=m[g]<0&&p>0?b:p;h.forEach((x,v)=>{u[v]&&x(y,g).forEach((w,M)=>{let _=p===is&&M===3?Math.
max(w,0):w;f[M]+=d*u[v]*_*(M<3?m[g]:1)})})}),f}}function Zo(a){let e=[0,0,0];return a.map(([t,r,n])=>{let s=T(e,[t,r,n])<
0?-1:1;return e=A(e,[t,r,n],s),s})}function Qo(a,e,t,r,n){let[s,o]=[a(0).slice(0,3),0],i=a(t+1)[3],c=Math.min(i,e[e.length-
1]),l=[];for(let h=0;h<e.length&&o<c;h+=1){let u=a(t+h+1).slice(0,3);for(let m=1;m<=ns;m+=1){let p=m/ns,f=Math.min(o+p*(e[h]-
o),c),d=(f-o)/(e[h]-o),g=s.map((b,y)=>b+d*(u[y]-b));if(l.push(k(g,r*f*n)),f===c)break}[s,o]=[u,e[h]]}return l}function us({
scene:a,place:e,position:t}){let{image:r,geometry:n}=a.header;if(!r)return l=>A(t,K(n.frame,l));let{alongI:s,alongJ:o}=r,
i=[as(s,e[0]),as(o,e[1])],c=Fe(a,e);return([l,h])=>{let u=[os(s,i[0]+l),os(o,i[1]+h)];return u.some(Number.isNaN)?null:A(
t,E(Fe(a,u),c))}}function Ne(a,e){return A(Fe(a,e),a.header.geometry.center)}function Fe(a,e){let{data:t}=a.part("positi\
on"),r=a.cornersAt(e),n=[0,1,2].map(s=>bt(r,o=>t[3*o+s]));return K(a.header.geometry.frame,n)}function ms(a,e){let{shape:t,
triangles:r}=a.header.geometry;if(r){let i=(c,l)=>Fe(a,Oe(Math.floor(e[1]),c,l));return[E(i(1,0),i(0,0)),E(i(0,1),i(0,0))]}
let[n,s]=e.map((i,c)=>P(i,.5,t[1-c]-1.5)),o=(i,c)=>Fe(a,[n+i,s+c]);return[E(o(.5,0),o(-.5,0)),E(o(0,.5),o(0,-.5))]}function as(a,e){let t=Math.min(Math.floor(e),a.length-2);return a[t]+(e-t)*(a[t+1]-a[t])}function os(a,e){let t=a.findIndex(
r=>r>=e);return t<0||e<a[0]?NaN:t===0?0:t-1+(e-a[t-1])/(a[t]-a[t-1])}function ei({scene:a,place:e,position:t},r,n,s){let{
geometry:o,image:i}=a.header,c=N(...ms(a,e)),{height:l,ray:h}=n.at(t),u=Math.max(Math.abs(T(C(c),h)),cs),m=2*l/s;if(i){let[
b,y]=[i.alongI,i.alongJ].map((v,w)=>{let M=Math.min(Math.floor(e[w]),v.length-2);return(v[M+1]-v[M])*i.stepSize[w]}),x=Math.
sqrt(O(c)/(b*y));return r.lod?Math.max(m/Math.sqrt(u),x):x}let p=o.extent/Number(r.resolution),f=T(h,n.at(n.state.focal_point).
ray),g=m*Math.sqrt(Math.max(f,ls/u)/u)*Number(r.grain);return r.lod?r.fixed_grain?Math.max(g,p):g:p}function ti(a,e,t){let{
scene:r,position:n}=a,{geometry:s,image:o}=r.header;if(o||!e.lod||e.fixed_grain)return 1;let i=C(N(...ms(r,a.place))),c=C(
N(i,K(s.frame,Ar(a)(0).slice(0,3))));if(O(c)<.5)return 1;let{ray:l}=t.at(n),h=T(i,l),u=(h<0?-1:1)*Math.max(Math.abs(h),cs),
[m,p]=t.axes.slice(0,2).map(v=>A(v,l,-T(i,v)/u)),f=O(N(m,p)),d=.5*(T(m,m)+T(p,p)),g=Math.sqrt(d+Math.sqrt(Math.max(d**2-
f**2,0))),b=Math.sqrt(g*Math.max(f/g,ls*g)),y=Math.hypot(T(m,c),T(p,c)),x=P(f/(y*b),1/ss,ss);return Math.abs(x-1)<qo?1:x}
function ri(a,e,t){let r=[],[n,s]=[a,t];for(let o of e){let i=O(E(o,n));if(i>=s){s>0&&r.push(A(n,E(o,n),s/(i||1)));break}
r.push(o),s-=i,n=o}return r}function ps([a,e,t]){return a===e?[[[a,a,0],1]]:[[[a,a,0],1-t],[[e,e,0],t]]}function Tr(a){let e=[
0,0,0];for(let[t,r]of ps(a.moment))r&&(e=A(e,ni({...a,moment:t}),r));return e}function ni(a){let{scene:e,position:t}=a,{
slices:r,image:n,speed:s}=e.header,o=Ar(a),[i,c,l]=o(0),h=[i,c,l],u=k(h,Ko*(n?1/n.stepSize[0]:r.cell)/(O(h)||1)),m=O(h)>
hs?E(us(a)(u)??t,t):h;return k(C(m),o(is)[3]*s.typical)}function fs(a,e,t,r){let{scene:n,position:s}=a,{slices:o,image:i}=n.
header,c=Ar(a),l=!ue(n.header),h=c(0),u=[h[0],h[1],h[2]],m=us(a),p=[],f=e.two_sided||!l?o.sides:1;for(let M=0;M<f&&O(u)>
hs;M+=1){let _=i?1:h[3]*o.unit,R=Qo(c,o.lags,M*o.lags.length,M?1:-1,_).map(m),L=R.findIndex(V=>V===null);p.push(R.slice(
0,L<0?void 0:L))}let d=Number(e.samples),g=ct(n.header,e,!0)?2*d-1:d,y=(f===2?Math.floor(g/2):g-1)*ti(a,e,t),x=Number(e.
spacing)*ei(a,e,t,r),v=M=>{let[_=[],S=[]]=p.map(R=>ri(s,R,M));return[..._.reverse(),s,...S]};return{path:v(Yo*Math.max(y,
Xo)*x),sampled:v(y*x),directed:l,velocity:Tr(a)}}var si=8,ai=1e-6,oi=.001,ii=89.99,ci=a=>a-360*Math.round(a/360);function _r([a,e]){return[[a,e],[a+1,e],[a,e+1],[a+1,e+1]]}
function xt({header:a},e){return e.map((t,r)=>P(Math.floor(t),0,a.geometry.shape[1-r]-2))}var ds=([a,e])=>[(1-a)*(1-e),a*
(1-e),(1-a)*e,a*e];function gs(a,e,[t,r],n){let{earth:s}=a.header,o=_r(e).map(d=>s&&yt(s,Ne(a,d),n));if(o.some(d=>!d||Math.
abs(d[1])>ii))return null;let[i,c,l,h]=o.map(d=>[ci(d[0]-t),d[1]-r]),[u,m]=[c,l].map(d=>[d[0]-i[0],d[1]-i[1]]),p=Math.max(
...[...u,...m].map(Math.abs)),f=u[0]*m[1]-u[1]*m[0];return!f||[0,1].some(d=>Math.abs(i[d]-c[d]-l[d]+h[d])>oi*p)?null:[(i[1]*
m[0]-i[0]*m[1])/f,(i[0]*u[1]-i[1]*u[0])/f]}function bs(a,e,t,r){let{earth:n,geometry:s}=a.header,o=n&&!s.triangles&&yt(n,
t,r);if(!o)return e;let i=xt(a,e);for(let c=0;c<si;c+=1){let l=gs(a,i,o,r);if(!l)return e;let h=l.map(m=>Math.abs(m-.5)>
.5+ai?m:0),u=xt(a,i.map((m,p)=>m+h[p]));if(String(u)===String(i))return i.map((m,p)=>m+P(l[p],0,1));i=u}return e}function ys(a,e){
let{earth:t,geometry:r}=a.header;if(!t||r.triangles)return a.cornersAt(e);let n=xt(a,e),s=ds(e.map((o,i)=>o-n[i]));return _r(
n).map(([o,i],c)=>[i*r.shape[1]+o,s[c]])}function xs(a,e){let{scene:t,place:r,position:n}=a,{earth:s,geometry:o}=t.header,
i=s&&yt(s,n,e);if(!i)return null;let c=m=>rs(s,m.position,Tr(m),e),l=xt(t,r);if(o.triangles||!gs(t,l,i,e))return c(a);let h=ds(
r.map((m,p)=>m-l[p])),u=_r(l).map(m=>c({...a,place:m,position:Ne(t,m)}));return[0,1].map(m=>u.reduce((p,f,d)=>p+h[d]*f[m],
0))}var li=16;function ws(a,e,t,r,[n,s]){let{layer:o,coordinate:i,triangle:c}=a,{geometry:l}=o.scene.header,h=l.triangles?Oe(
c,...i):hi(l,...i),u=t.ray(n,s),m=vs(o.scene,h,u)[1],[p,f]=vs(o.scene,m,u),d=bs(o.scene,f,p,e.parts.get("lonlat")),g=l.triangles?
d:ui(e.header,o,d);return{point:{position:p,index:g,values:mi(o.scene,r,d)},layer:o,place:d}}function hi({rows:a,columns:e,
shape:t},r,n){let s=(o,{size:i,before:c},l)=>P(o*i-.5-c,0,l-1);return[s(r,e,t[1]),s(n,a,t[0])]}function ui(a,{key:e},[t,
r]){let{pyramid:n,geometry:s,mesh:o,formula:i}=a,[c,l,h]=e,[u,m]=n?.shapes[0]??s.shape,p=o.tileCells*(n?.tileBlocks??0),
f=i?2**(n?.depth??0):1,d=(g,b,y)=>pt(g+b*p,c,y)/f;return[d(t,h,m),d(r,l,u)]}function vs(a,e,[t,r]){let{geometry:n}=a.header,
{data:s}=a.part("position"),o=a.cornersAt(e).map(([v])=>v),[i,c,l]=o.map(v=>A(K(n.frame,[...s.subarray(3*v,3*v+3)]),n.center)),
[h,u]=[E(c,i),E(l,i)],m=N(h,u),p=A(t,r,T(m,E(i,t))/T(m,r)),f=E(p,i),[d,g]=[N(f,u),N(h,f)].map(v=>T(v,m)/T(m,m));if(!(Math.
max(Math.abs(d),Math.abs(g))<li)){let v=Ne(a,e);return[A(t,r,T(E(v,t),r)/T(r,r)),e]}if(n.triangles)return[p,Oe(Math.floor(
e[1]),d,Math.max(g,0))];let[b,y]=n.shape,x=(v,w)=>{let[M,_,S]=o.map(v);return P(M+d*(_-M)+g*(S-M),0,w-1)};return[p,[x(v=>v%
y,y),x(v=>Math.floor(v/y),b)]]}function mi(a,e,t){let{header:r,parts:n}=a,{scalars:s,geometry:o}=r,i=ys(a,t),c=o.triangles?
Math.floor(t[1]):i[0][0],[l,h,u]=e,m={},p=s.choices.map((f,d)=>({...f,number:d}));for(let f of[s,...p]){let d=a.scalarParts(
l,h,f),[g,b]=d.map(x=>n.get(x)?.data);if(f.name===null||f.name in m||!g||!b)continue;let y=x=>g[x]+u*(b[x]-g[x]);m[f.name]=
f.flat?y(c):bt(i,y)}return m}var pi=3,Ms=5;function Es({shape:a,triangles:e},t,r,n){let[s,o]=t.shape,i=new Int8Array(s*o).fill(e?0:Math.log2(n));for(let c=0;c<
r.length;c+=3){if(Number.isFinite(r[c]))continue;let[l,h]=[Math.floor(c/3/a[1]),c/3%a[1]];for(let u of[Math.floor((l-1)/
n),Math.floor(l/n)])for(let m of[Math.floor((h-1)/n),Math.floor(h/n)])u>=0&&u<s&&m>=0&&m<o&&(i[u*o+m]=0)}return i}function Ss({
shape:a,data:e},t,r,n,s){let[o,i]=a,c={...t.sight(r),planes:t.planes},l=new Int8Array(o*i).fill(-1),h=[1,1,-1,-1];for(let u=0;u<
l.length;u+=1){let[m,p]=[Math.floor(u/i),u%i],f=e.subarray(Ms*u,Ms*(u+1));if(n.some(([b,y,x])=>m>=b&&m<b+x&&p>=y&&p<y+x)||
!wr(c,f))continue;let g=Math.floor(Math.log2(pi/Mr(c,f)));l[u]=Math.min(Math.max(g,0),s[u]),fi(t,f).forEach((b,y)=>h[y]=
y<2?Math.min(h[y],b):Math.max(h[y],b))}return{levels:l,box:h}}function fi(a,[e,t,r,n]){let[s,o,i]=a.axes,{parallel:c,position:l,
focal_point:h}=a.state,u=E([e,t,r],c?h:l),m=[-n,n].map(d=>a.at(A([e,t,r],i,d)).height);if(!(m[0]>0))return[-1,-1,1,1];let[
p,f]=[-n,n].map(d=>[T(u,s)/a.aspect,T(u,o)].map((g,b)=>m.map(y=>(g+d/(b?1:a.aspect))/y)));return[...p.map(d=>Math.min(...d)),
...f.map(d=>Math.max(...d))]}var di=1024,As=["u_places","u_depths","u_colours","u_strides"].map(a=>de.indexOf(a)),vt=class{width=0;height=0;graphics;target=null;key="";layers=[];seen=[];squares=0;constructor(e){
this.graphics=e}draw({layers:e,camera:t,anchor:r,width:n,height:s}){let o=e.map(({scene:p,covered:f})=>[p.number,p.version,
f]),i=JSON.stringify([o,t.state,t.aspect,r,n,s]);if(i===this.key)return;Object.assign(this,{key:i,layers:e,width:n,height:s});
let c=this.graphics.context,{frames:l}=this.make(n,s),[{scene:h}]=e,u=Math.min(...e.map(({key:[p]})=>p))+Math.log2(h.header.
mesh.tileCells);this.seen=e.map(({scene:p,covered:f,key:[d]})=>{let g=p.doublings.map(b=>Math.max(Math.min(b,u-d),0));return Ss(
p.blocks,t,s,f,g)}),this.sendStrides(),c.bindFramebuffer(c.FRAMEBUFFER,l[0]),c.viewport(0,0,n,s),c.disable(c.SCISSOR_TEST),
c.enable(c.DEPTH_TEST),c.depthFunc(c.LESS),c.disable(c.BLEND),c.clearBufferuiv(c.COLOR,0,[0,0,0,0]),c.clear(c.DEPTH_BUFFER_BIT);
let m=z(h.header.geometry,t,r);h.bodies.hide(m,r),h.bodies.seeThrough(()=>this.triangles(h.programs("place"),m,r),!1)}triangles(e,t,r,n={}){
let{graphics:s,layers:o,seen:i}=this,c=s.context,{mesh:l,pyramid:h,geometry:u}=o[0].scene.header,[m,p]=h?.shapes[0]??u.shape;
this.bind(),c.bindVertexArray(null),o.forEach(({scene:f,key:[d,...g]},b)=>{let{levels:y}=i[b],{columns:x,rows:v,shape:w,
triangles:M}=f.header.geometry,[_,S]=g.map(L=>L*l.tileCells*(h?.tileBlocks??0)*2**d);f.bindNodes(r),s.programs.use(e,{...n,
u_matrix:t,u_layer:b+1,u_blocks:y.reduce((L,V,I)=>L|(V<0?0:1<<I),0),u_part:[S,_,d],u_lastNode:[p-1,m-1,this.squares],u_closed:[
Number(u.periodic[1]),Number(u.periodic[0])],u_blockCells:l.tileCells,u_slicesSize:[x.size,v.size],u_padding:[x.before,v.
before]}),M&&c.drawArrays(c.TRIANGLES,0,f.part("triangles").data.length);let R=f.blocks.shape[1];y.forEach((L,V)=>{if(L<
0||M)return;let I=[V%R,Math.floor(V/R)].map(U=>U*l.tileCells),[J,se]=I.map((U,Z)=>Math.ceil(Math.min(l.tileCells,w[1-Z]-
1-U)/2**L));s.programs.use(e,{u_block:[...I,L,J]}),c.drawArrays(c.TRIANGLES,0,6*J*se)})})}sum(e,t,r,n){let{graphics:s,width:o,
height:i,target:c}=this,l=s.context,h=i-t-r;l.bindFramebuffer(l.FRAMEBUFFER,c?.frames[1]??null),l.viewport(0,0,o,i),l.enable(
l.SCISSOR_TEST),l.disable(l.DEPTH_TEST),l.disable(l.BLEND),l.bindVertexArray(null),this.layers.forEach(({scene:u},m)=>{let[
p,f,d,g]=this.seen[m].box.map((M,_)=>(.5+.5*M)*(_%2?i:o)),[b,y]=[Math.max(Math.floor(p),0),Math.max(Math.floor(f),h)],[x,
v]=[Math.min(Math.ceil(d),o)-b,Math.min(Math.ceil(g),h+r)-y];if(x<=0||v<=0)return;l.scissor(b,y,x,v);let w=n(u);this.bind(),
s.programs.use(e,{...w,u_layer:m+1}),l.drawArrays(l.TRIANGLES,0,3)}),l.readPixels(0,0,1,1,l.RGBA,l.UNSIGNED_BYTE,new Uint8Array(
4)),l.bindFramebuffer(l.FRAMEBUFFER,null)}show(e){let t=this.graphics.context;this.bind(),t.bindVertexArray(null),this.graphics.
programs.use(e,{u_bottom:0}),t.drawArrays(t.TRIANGLES,0,3)}at(e,t){let{graphics:r,target:n,layers:s}=this,o=r.context,[i,
c]=[(.5+.5*e)*this.width,(.5+.5*t)*this.height],l=P(Math.floor(i-.5),0,this.width-2),h=P(Math.floor(c-.5),0,this.height-
2),u=new Uint32Array(16);o.bindFramebuffer(o.FRAMEBUFFER,n?.frames[0]??null),o.readPixels(l,h,2,2,o.RGBA_INTEGER,o.UNSIGNED_INT,
u),o.bindFramebuffer(o.FRAMEBUFFER,null);let m=+(i>=l+1)+2*+(c>=h+1),p=4*([m,m^1,m^2,m^3].find(g=>u[4*g+3])??m),[f,d]=new Float32Array(
u.buffer,4*p,2);return u[p+3]?{layer:s[u[p+3]-1],coordinate:[f,d],triangle:u[p+2]}:null}dispose(){let{graphics:e,target:t}=this;
for(let r of t?.textures??[])e.free("Texture",r);for(let r of t?.frames??[])e.free("Framebuffer",r);this.target=null,this.
key=""}sendStrides(){let{layers:e,seen:t,target:r}=this,n=this.graphics.context,[{scene:s}]=e,{pyramid:o,geometry:i}=s.header,
c=i.triangles?[1,1]:o?.blocks[0]??s.blocks.shape;this.squares=Math.max(Math.ceil(Math.log2(Math.max(...c)/di)),0);let l=2**
-this.squares,[h,u]=c.map(p=>Math.ceil(p*l)),m=new Uint8Array(h*u);e.forEach(({scene:p,key:[f,...d]},g)=>{let b=p.blocks.
shape[1],y=2**f*l;t[g].levels.forEach((x,v)=>{if(x<0||i.triangles)return;let[[w,M],[_,S]]=[Math.floor(v/b),v%b].map((R,L)=>{
let V=(R+d[L]*(o?.tileBlocks??0))*y;return[Math.floor(V),Math.min(Math.ceil(V+y),[h,u][L])]});for(let R=w;R<M;R+=1)for(let L=_+
R*u;L<S+R*u;L+=1)m[L]=Math.max(m[L],f+x)})}),n.activeTexture(n.TEXTURE0+As[3]),n.bindTexture(n.TEXTURE_2D,r?.textures[3]??
null),n.pixelStorei(n.UNPACK_ALIGNMENT,1),n.texImage2D(n.TEXTURE_2D,0,n.R8UI,u,h,0,n.RED_INTEGER,n.UNSIGNED_BYTE,m)}make(e,t){
let{target:r,graphics:n}=this;if(r&&r.width>=e&&r.height>=t)return r;let s=n.context,{key:o}=this,i={width:Math.max(e,r?.
width??0),height:Math.max(t,r?.height??0)};this.dispose();let c=[s.RGBA32UI,s.DEPTH_COMPONENT24,s.RGBA8,0].map(h=>{let u=n.
counted(s.createTexture());return s.bindTexture(s.TEXTURE_2D,u),h&&s.texStorage2D(s.TEXTURE_2D,1,h,i.width,i.height),s.texParameteri(
s.TEXTURE_2D,s.TEXTURE_MIN_FILTER,s.NEAREST),s.texParameteri(s.TEXTURE_2D,s.TEXTURE_MAG_FILTER,s.NEAREST),u}),l=[[c[0],c[1]],
[c[2]]].map(h=>{let u=n.counted(s.createFramebuffer());return s.bindFramebuffer(s.FRAMEBUFFER,u),h.forEach((m,p)=>{let f=p?
s.DEPTH_ATTACHMENT:s.COLOR_ATTACHMENT0;s.framebufferTexture2D(s.FRAMEBUFFER,f,s.TEXTURE_2D,m,0)}),u});return this.key=o,
this.target={frames:l,textures:c,...i}}bind(){let e=this.graphics.context;As.forEach((t,r)=>{e.activeTexture(e.TEXTURE0+
t),e.bindTexture(e.TEXTURE_2D,this.target?.textures[r]??null)}),e.activeTexture(e.TEXTURE0+de.length)}};function Ts(a,e){var t=e[0],r=e[1],n=e[2],s=e[3],o=e[4],i=e[5],c=t*s-r*n;return c?(c=1/c,a[0]=s*c,a[1]=-r*c,a[2]=-n*c,a[3]=
t*c,a[4]=(n*i-s*o)*c,a[5]=(r*o-t*i)*c,a):null}function _s(a){return a[0]*a[3]-a[1]*a[2]}function Ps(a,e,t){var r=e[0],n=e[1],
s=e[2],o=e[3],i=e[4],c=e[5],l=t[0],h=t[1],u=t[2],m=t[3],p=t[4],f=t[5];return a[0]=r*l+s*h,a[1]=n*l+o*h,a[2]=r*u+s*m,a[3]=
n*u+o*m,a[4]=r*p+s*f+i,a[5]=n*p+o*f+c,a}var bi=14,yi=40,xi=256;function Rs(a,e){a?.clearRect(0,0,e.width,e.height),a?.drawImage(e,0,0)}var vi=(a,e)=>a.getContext(
"2d",{alpha:e}),wt=class{viewer;content;graphics;canvas;pen;last=document.createElement("canvas");lastPen;lastCamera=null;coarse=document.
createElement("canvas");coarsePen;front=document.createElement("canvas");frontPen=this.front.getContext("2d");frontLook="";version=1;draftVersion=0;rowsDone=0;layers=[];isRefined=!1;fixed=4;isCoarse=!1;constructor(e,t){
this.viewer=e,this.content=t,this.graphics=e.graphics,this.canvas=e.canvas;let{canvas:r,last:n,coarse:s}=this,o=[r,n,s].
map(i=>vi(i,e.isClear??!1));[this.pen,this.lastPen,this.coarsePen]=o}restart(e=!1){e||(this.lastCamera=null),this.version+=
1,this.rowsDone=0}refine(){(this.rowsDone>=this.canvas.height||!this.content.isComing)&&(this.rowsDone=0),this.isRefined=
!0}resize(e,t){let{canvas:r,coarse:n,last:s}=this;n.width=r.width,n.height=r.height,this.coarsePen?.drawImage(r,0,0),r.width=
s.width=e,r.height=s.height=t,n.width>1&&this.pen?.drawImage(n,0,0,e,t)}dispose(){for(let e of[this.last,this.coarse,this.
front])e.width=e.height=0}draw(e,t,r){let n=this.isMoving;if(this.draftVersion!==this.version)return this.draft(e,t,n);if(n)
return!1;let s=!1;do s=this.strip(e,t)&&!this.isRefined;while(!s&&performance.now()<r);return s}get isMoving(){return this.
viewer.player.playing||this.viewer.isHeld}get leavesOut(){return this.isCoarse&&this.isMoving}arrange(e){this.isRefined=
!1,this.layers=this.content.arrange(e)}draft(e,t,r){let{width:n,height:s}=this.canvas,o=Number(this.viewer.settings.samples),
i=r?this.graphics.waiting.size+1:1;this.arrange(t);let c=e.price*this.factor(o),l=this.viewer.player.playing&&!this.viewer.
isHeld,h=An(c,this.fixed,n*s,o,l),u=Math.max(h/i,bi),m=Sn(c,this.fixed,n*s,o,u),p=Math.max(Math.round(n*m.scale),1),f=Math.
max(Math.round(s*m.scale),1);this.draftVersion=this.version;let d=m.scale<1?this.reuse():null;if(!d?.covers){let b=performance.
now();this.place(t,p,f);let y=this.sum(e,t,0,f,m.samples);this.show(t,!1),this.fixed+=.5*(P(performance.now()-b-y,.5,500)-
this.fixed)}d&&this.pen&&(this.pen.imageSmoothingEnabled=!d.shifts,this.pen.setTransform(...d.matrix),Rs(this.pen,this.last),
this.pen.setTransform(1,0,0,1,0,0)),this.isCoarse=m.scale<1||m.samples<o;let g=!this.isCoarse&&!this.content.smooth;return g&&
this.complete(),this.drawLines(t),g&&!this.isRefined}strip(e,t){let{width:r,height:n}=this.canvas,s=Number(this.viewer.settings.
samples);if(this.rowsDone>=n&&(this.rowsDone=0),this.rowsDone===0&&(this.arrange(t),this.isRefined))return!1;this.place(
t,r,n);let o=e.price*this.factor(s),i=Math.min(n-this.rowsDone,Tn(yi,o,r,s));return this.sum(e,t,this.rowsDone,i,s),this.
rowsDone+=i,this.rowsDone<n?!1:(this.show(t,this.content.smooth),this.complete(),this.drawLines(t),!0)}drawLines(e){let{
front:t,frontPen:r,graphics:n}=this,{camera:s,ratio:o}=this.viewer,{scene:i}=this.content,{width:c,height:l}=this.canvas;
if(!i||!s||!r)return;let{earth:h,bodies:u}=i;if(!h.lines.length&&!u.labels.length)return;let{state:m,aspect:p}=s,f=JSON.
stringify([m,p,c,l,h.lines,h.version]);if(f!==this.frontLook){let{anchor:d}=this.viewer.view(e,o),{canvas:g}=n;g.width<c&&
(g.width=c),g.height<l&&(g.height=l),t.width=c,t.height=l,h.drawLines({camera:s,anchor:d,width:c,height:l,ratio:o},()=>{
let b=g.height-l;r.drawImage(g,0,b,c,l,0,0,c,l)}),u.drawLabels(r,{camera:s,anchor:d,width:c,height:l,ratio:o}),this.frontLook=
f}this.pen?.drawImage(t,0,0)}complete(){let{camera:e,player:t}=this.viewer;this.rowsDone=this.canvas.height,this.isCoarse=
!1,this.draftVersion=this.version,Rs(this.lastPen,this.canvas),e&&!t.playing&&(this.lastCamera=new fe(e.state,e.limits,e.
flat,e.aspect))}reuse(){let{lastCamera:e}=this,{camera:t}=this.viewer,{scene:r}=this.content;if(!r?.header.geometry.planar||
!t||!e||!t.state.parallel||!e.state.parallel)return null;let{geometry:n}=r.header,s=E(t.state.focal_point,n.center),o=F(
n.frame,s),[i,c]=[e,t].map(l=>z(n,l,o));return Ei(i,c,this.canvas.width,this.canvas.height)}factor(e){let{settings:t,player:r}=this.
viewer;return t.motion!=="off"||r.varies&&r.playing?_n(e):1}placeAt(e,t,r){let{places:n}=this.content;return this.place(
e,n?.width||this.canvas.width,n?.height||this.canvas.height),n?.at(t,r)??null}place(e,t,r){let{viewer:n,layers:s,content:o}=this,
{camera:i}=n;if(!i||!s.length)return;let{anchor:c}=n.view(e,this.density(r));o.places?.draw({layers:s,camera:i,anchor:c,
width:t,height:r})}density(e){return this.viewer.ratio*e/this.canvas.height}sum(e,t,r,n,s){let{places:o,scene:i}=this.content,
{camera:c}=this.viewer;if(!o||!i||!c)return 0;let{width:l,height:h}=o,u=this.viewer.view(t,this.density(h)),m=s!==this.viewer.
settings.samples||h!==this.canvas.height,p=g=>(g.bindNodes(u.anchor),g.bindTextures(t[0],t[1]),{...this.values(g,i,c,u,s,
m),...xn(g.header.geometry,c,u.anchor,l,h)});e.warm||o.sum(e,r,1,p),e.warm=!0;let f=performance.now();o.sum(e,r,n,p);let d=performance.
now()-f;return e.price=Pn(e.price,d,l*n,s,this.factor(s)),d}show(e,t){let{places:r}=this.content;if(!r)return;let{width:n,
height:s}=r,{canvas:o}=this.graphics;o.width<n&&(o.width=n),o.height<s&&(o.height=s);let i=t?xi:s;for(let c=0;c<s;c+=i)this.
render(e,c,Math.min(i,s-c),t)}render(e,t,r,n){let{graphics:s,viewer:o}=this,{camera:i}=o,{scene:c,places:l}=this.content;
if(!i||!c||!l)return;let h=s.context,{width:u,height:m}=l,p=o.view(e,this.density(m));n?s.bindSmooth(u,r):h.bindFramebuffer(
h.FRAMEBUFFER,null),h.viewport(0,-t,u,m),h.enable(h.SCISSOR_TEST),h.scissor(0,0,u,r),h.enable(h.DEPTH_TEST),h.depthFunc(
h.LESS),h.disable(h.BLEND),h.disable(h.CULL_FACE);let[f,d,g]=c.header.background??[1,1,1];h.clearColor(f,d,g,o.isClear?0:
1),h.clear(h.COLOR_BUFFER_BIT|h.DEPTH_BUFFER_BIT);let b={camera:i,anchor:p.anchor,width:u,height:m,ratio:o.ratio};c.earth.
drawGround(b);let{bodies:y}=c;y.draw(b,"opaque"),y.seeThrough(()=>{if(!n)return l.show(c.programs("surface"));let x=z(c.
header.geometry,i,p.anchor);l.triangles(c.programs("smooth"),x,p.anchor,{u_bottom:t})}),this.drawArrows(e,p,u,m),y.draw(
b,"clear"),c.marks.draw({...b,ratio:p.density},o.settings,e),n&&s.copySmooth(u,r),this.copy(u,m,t,r)}drawArrows(e,t,r,n){
let{camera:s,settings:o}=this.viewer,{scene:i}=this.content;if(!i||!s||!Le(i.header,o))return;let c={...s.sight(n/t.density),
planes:s.planes},l=n!==this.canvas.height,h=this.layers.map(u=>u.scene);for(let[u,m]of i.arrows.share(c,o,h)){let{arrows:p,
header:f}=u,d=p.program(o,lt(f,o,t));if(!d||!m.length)continue;u.bindTextures(e[0],e[1]);let g=u.scalarParts(e[0],e[1]),
b=this.values(u,i,s,t,Number(o.samples),l);p.draw(d,m,g,t.anchor,{...b,u_picture:[r,n]})}}values({header:e},{bodies:t},r,n,s,o){
let{settings:i}=this.viewer,{columns:c,rows:l}=e.geometry,h=e.scalars.name!==null&&Le(e,i)&&i.arrow_color==="scalars";return{
...Cn(e,{...i,samples:s},n),...o?Rn(i,s,n.density):{},u_matrix:z(e.geometry,r,n.anchor),u_mapped:e.scalars.name!==null&&
!h,u_plain:h,u_flat:!!e.scalars.flat,u_padding:[c.before,l.before],u_colour:e.colour,u_lit:e.lighting,u_ground:e.background??
[1,1,1],u_opacity:t.areBehind?1:e.opacity,u_toEye:F(e.geometry.frame,k(r.axes[2],-1))}}copy(e,t,r,n){let{pen:s}=this;if(!s)
return;let{canvas:o}=this.graphics,i=o.height-n,[c,l]=[this.canvas.width,this.canvas.height/t];if(s.imageSmoothingEnabled=
c!==e||l!==1,s.imageSmoothingEnabled){let{coarse:u,coarsePen:m}=this;u.width=e,u.height=n,m?.drawImage(o,0,i,e,n,0,0,e,n),
[o,i]=[u,0]}let h=(t-r-n)*l;s.clearRect(0,h,c,n*l),s.drawImage(o,0,i,e,n,0,h,c,n*l)}},wi=4,Mi=.3,Pr=1e-6,Ls=(a,e)=>Ps([0,
0,0,0,0,0],a,e),ks=a=>Ts([0,0,0,0,0,0],a);function Ei(a,e,t,r){let[n,s]=[t/2,r/2],o=M=>Ls([n,0,0,-s,n,s],[M[0],M[1],M[4],
M[5],M[12],M[13]]),i=Ls(o(e),ks(o(a))),c=Math.abs(_s(i));if(!(c>Mi**2&&c<wi**2))return null;let[l,h,u,m,p,f]=ks(i),d=([M,
_])=>Math.abs((l*M+u*_+p)/n-1)<1+Pr&&Math.abs((h*M+m*_+f)/s-1)<1+Pr,g=[[0,0],[t,0],[0,r],[t,r]].every(d),[b,y,x,v]=i,w=Math.
abs(b-1)+Math.abs(v-1)+Math.abs(y)+Math.abs(x)<Pr;if(w)for(let M of[4,5])i[M]=Math.round(i[M]);return{matrix:i,covers:g,
shifts:w}}var At=4,Tt=class{surface;limits;sums;whole=[[]];last=null;constructor(e,t){this.surface=e,this.limits=t;let r=0;this.sums=
Float64Array.from({length:e.corners.length/At},(n,s)=>r+=this.area(Rr(s)))}seen(e,t){return(!this.last||!this.covers(this.
last.wanted,[e,t]))&&(this.last={wanted:[e,t],seeds:this.make([e,t])}),this.last.seeds}position(e,t){let{nodes:r,corners:n}=this.
surface;return Ie(r,n.subarray(At*e,At*(e+1)),t,3)}point(e){let{frame:t,center:r}=this.surface.geometry;return A(K(t,e),
r)}covers([e,t],[r,n]){let{closer:s}=this.limits;return this.cornersOf(r).every(o=>s*t*St(e,o)<=n*St(r,o)&&this.sees(e,o,
0))}cornersOf({planes:e}){let{center:t,extent:r}=this.surface.geometry,n=c=>e[c].slice(0,3),s=N(n(0),n(2)),o=.5*r*O(s);return[
0,1].flatMap(c=>[2,3].flatMap(l=>[-1,1].map(h=>[c,l,h]))).map(([c,l,h])=>{let[u,m]=[n(c),n(l)],p=A(k(N(m,s),-e[c][3]),N(
s,u),-e[l][3]),f=N(u,m);return k(A(p,f,T(s,t)+h*o),1/T(f,s))})}sees(e,t,r){let n=r+this.limits.around*e.pixels*St(e,t);return e.
planes.every(s=>T(s,t)+s[3]>=-n*O(s))}make(e){let[t,r]=e,{limits:n,sums:s,whole:o}=this,{extent:i,center:c}=this.surface.
geometry,l=s[s.length-1]??0,h=t.eye?Math.max(O(E(c,t.eye))-.5*i,0):1,u=n.closer*r*Lr(t,h),m=i,p=o[0],f=null;for(let d=0;d<
n.mostOctaves;d+=1){let g=n.candidateArea*m**2;if(l<=n.mostCandidates*g)o[d+1]??=this.grown(p,this.spread(d,g),m),p=o[d+
1];else{f??=Array.from(s,(y,x)=>Rr(x)),f=this.divided(f.filter(y=>this.isNeeded(y,e,m)),g);let b=f.flatMap(y=>{let x=ce(
y.key+d);return Et(x)*g<this.area(y)?[this.candidate(y,x)]:[]});if(p=this.grown(p,b,m),!f.length)break}if(m<=u)break;m*=
n.octave}return p.filter(d=>{let g=this.point(d.position);return d.radius>=n.closer*r*St(t,g)&&this.sees(t,g,0)})}spread(e,t){
let{sums:r}=this,n=ce(e+Mt),s=0;return Array.from({length:Math.floor((r[r.length-1]??0)/t)},(o,i)=>{let c=ce(n+i),l=(i+Et(
c))*t;for(;s<r.length-1&&r[s]<=l;)s+=1;return this.candidate(Rr(s),c)})}candidate({cell:e,low:t,size:r},n){let s=ce(n+Mt),
o=ce(s+Mt),i=[t[0]+r[0]*Et(s),t[1]+r[1]*Et(o)];return{cell:e,place:i,position:this.position(e,i),radius:1/0}}grown(e,t,r){
let n=r/this.limits.octave,s=new _t(n);for(let l of e)s.add(l.position);for(let l of t)l.radius=s.distance(l.position);let o=t.
filter(({radius:l})=>l>=r).sort((l,h)=>h.radius-l.radius),i=new _t(n),c=o.filter(l=>(l.radius=Math.min(l.radius,i.distance(
l.position)),l.radius<r?!1:(i.add(l.position),!0)));return[...e,...c]}isNeeded(e,[t,r],n){let{octave:s,closer:o,aroundRadii:i}=this.
limits,{cell:c,low:l,size:h}=e,u=this.point(this.position(c,[l[0]+.5*h[0],l[1]+.5*h[1]])),[m,p]=this.sides(e),f=.5*(O(m)+
O(p)),d=Math.max(Ns(t,u)-f,0);return!(n<s*o*r*Lr(t,d))&&this.sees(t,u,f+i*n)}divided(e,t){let r=e.filter(o=>this.area(o)>
t);if(!r.length)return e;let n=r.map(o=>{let[i,c]=this.sides(o),l=O(c)>O(i)?1:0,h=[...o.size];h[l]*=.5;let u=[...o.low];
return u[l]+=h[l],[{...o,size:h,key:ce(o.key+Mt)},{...o,size:h,low:u,key:ce(o.key+Si)}]}),s=e.filter(o=>this.area(o)<=t);
return this.divided([...s,...n.map(([o])=>o),...n.map(([,o])=>o)],t)}sides({cell:e,low:t,size:r}){let n=(s,o)=>this.position(
e,[t[0]+r[0]*s,t[1]+r[1]*o]);return[E(n(1,.5),n(0,.5)),E(n(.5,1),n(.5,0))]}area(e){return O(N(...this.sides(e)))}};function Ie(a,e,[
t,r],n){let s=[(1-r)*(1-t),(1-r)*t,r*(1-t),r*t],o=new Array(n).fill(0);for(let i=0;i<At;i+=1)for(let c=0;c<n;c+=1)o[c]+=
s[i]*a[n*e[i]+c];return o}var _t=class{most;cubes=new Map;constructor(e){this.most=e}cube(e){return e.map(t=>Math.floor(
t/this.most))}add(e){let t=Fs(...this.cube(e)),r=this.cubes.get(t);r?r.push(e):this.cubes.set(t,[e])}distance(e){let[t,r,
n]=this.cube(e),s=this.most;for(let o=0;o<27;o+=1){let i=Fs(t+o%3-1,r+Math.floor(o/3)%3-1,n+Math.floor(o/9)-1);for(let c of this.
cubes.get(i)??[])s=Math.min(s,O(E(e,c)))}return s}},Mt=2654435769,Si=2246822507,Ai=[739982445,695872825],Os=15;function Fs(a,e,t){
return Math.imul(a,2376512323)^Math.imul(e,3625334849)^Math.imul(t,3407524639)}function ce(a){let e=a>>>0;for(let t of Ai)
e=Math.imul(e^e>>>Os,t)>>>0;return(e^e>>>Os)>>>0}var Et=a=>a/2**32;function Rr(a){return{cell:a,low:[0,0],size:[1,1],key:ce(
a)}}var Ns=({eye:a},e)=>a?O(E(e,a)):1,Lr=({halfHeight:a,pixels:e},t)=>2*a/e*t,St=(a,e)=>Lr(a,Ns(a,e));var Vs=[[0,3],[1,2],[2,3],[3,2],[4,3],[5,1]],Is=4,Ti=Vs.reduce((a,[,e])=>a+e,0),_i=(a,e)=>a.length===e.length&&a.every((t,r)=>t===
e[r]),Cs=({tile:a})=>a?.[0]??1/0,Pt=class{graphics;header;parts;seeds=null;array=null;buffer=null;known=null;last=null;drawn=null;constructor(e,t,r){
this.graphics=e,this.header=t,this.parts=r}program(e,t){let{shaders:r,geometry:n}=this.header;if(!Le(this.header,e))return null;
let s=t&&!n.triangles?["FLOWTEX_CELLS"]:[];return this.graphics.programs.get(r.arrowVertex,r.arrowFragment,...s)}share(e,t,r){
let{header:n,last:s}=this;this.seeds??=new Tt(this.surface,n.constants.arrows);let o=this.seeds.seen(e,xr(n,t));if(s?.seeds===
o&&_i(r,s.layers))return s.shared;let{corners:i}=this.surface,c=o.map(({cell:u,place:m,radius:p})=>{let f=i.subarray(4*u,
4*u+4);return{corners:f,place:m,radius:p,cell:n.geometry.triangles?u:f[0]}}),l=new Map(r.map(u=>[u,[]])),h=[...r].sort((u,m)=>Cs(
u)-Cs(m));for(let u of c)for(let m of h){let p=m.tile?this.inTile(u,m,m.tile):u;if(p){l.get(m)?.push(p);break}}return this.
last={seeds:o,layers:r,shared:l},l}draw(e,t,r,n,s){let{graphics:o}=this,i=o.context;this.array??=this.make(),i.bindVertexArray(
this.array);let{name:c,low:l,high:h,log:u}=this.header.scalars,m=r.map(f=>this.parts.get(f)?.digest),p=JSON.stringify([n,
r,m,c,l,h,u]);(this.drawn?.placed!==t||this.drawn.key!==p)&&(i.bindBuffer(i.ARRAY_BUFFER,this.buffer),i.bufferData(i.ARRAY_BUFFER,
this.numbers(t,r,n),i.DYNAMIC_DRAW),this.drawn={placed:t,key:p}),o.programs.use(e,s),i.enable(i.BLEND),i.blendFuncSeparate(
i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ZERO,i.ONE),i.depthMask(!1),i.drawArraysInstanced(i.TRIANGLE_STRIP,0,2*(this.header.
constants.arrows.pieces+1),t.length),i.depthMask(!0),i.disable(i.BLEND),i.bindVertexArray(null)}forget(){this.known=this.
seeds=this.last=this.drawn=null}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("VertexArray",this.
array),this.array=this.buffer=null,this.forget()}inTile({corners:e,place:t,radius:r},n,[s,o,i]){let{geometry:c,pyramid:l,
mesh:h}=this.header;if(!l||c.triangles)return null;let u=h.tileCells*l.tileBlocks,[m,p]=n.header.geometry.shape,f=c.shape[1],
d=(x,v,w,M)=>{let _=l.shapes[0][v],S=Gn(pt(x,l.depth,_),s,_)-w*u,R=Math.min(Math.max(Math.floor(S),0),M-1);return S<0||S>
M?null:[R,S-R]},g=d(e[0]%f+t[0],1,i,p-1),b=d(Math.floor(e[0]/f)+t[1],0,o,m-1);if(!g||!b||n.parts.get("cells")?.data[b[0]*
(p-1)+g[0]]===0)return null;let y=b[0]*p+g[0];return{corners:[y,y+1,y+p,y+p+1],place:[g[1],b[1]],radius:r,cell:y}}make(){
let e=this.graphics.context,t=this.graphics.counted(e.createVertexArray());this.buffer=this.graphics.counted(e.createBuffer()),
e.bindVertexArray(t),e.bindBuffer(e.ARRAY_BUFFER,this.buffer);let r=0;for(let[n,s]of Vs)e.enableVertexAttribArray(n),e.vertexAttribPointer(
n,s,e.FLOAT,!1,Ti*Is,r),e.vertexAttribDivisor(n,1),r+=s*Is;return t}numbers(e,t,r){let{geometry:n,scalars:s}=this.header,
o=t.map(h=>this.parts.get(h)?.data??new Float32Array),i=gt(o,s),c=this.nodes,l=n.triangles?null:Xn(n);return Float32Array.
from(e.flatMap(({corners:h,place:u,radius:m,cell:p})=>{let[f,d]=u,[g,b,y,x]=Array.from(h,w=>[...c.subarray(3*w,3*w+3)]),
v=N(E(A(b,x),A(g,y)),E(A(y,x),A(g,b)));return[...E(Ie(c,h,u,3),r),...l?Ie(l,h,u,2):[f*(1-d),d],...C(v),...s.flat?i.subarray(
2*p,2*p+2):Ie(i,h,u,2),...Array.from(h).slice(0,3),m]}))}get nodes(){return this.parts.get("position")?.data??new Float32Array}get surface(){
return this.known??={geometry:this.header.geometry,nodes:this.nodes,corners:this.corners()}}corners(){let{geometry:e}=this.
header,[t,r]=e.shape,n=[];if(e.triangles){let o=this.parts.get("triangles")?.data??[];for(let i=0;i<o.length;i+=3)n.push(
o[i],o[i+1],o[i+2],o[i+2]);return Uint32Array.from(n)}let s=this.parts.get("cells")?.data;for(let o=0;o<(t-1)*(r-1);o+=1){
if(s&&!s[o])continue;let i=o+Math.floor(o/(r-1));n.push(i,i+1,i+r,i+r+1)}return Uint32Array.from(n)}};var Ce=["bodyPoints","bodyNormals","bodyColours","bodyFaces","bodyPieces"],Us=8,[Pi,Ri]=[24,8],Te=[1,2],Li=.2;function Ve(a,e,t){
let r=a.constructor,n=new r(t*e.length);for(let s=0;s<e.length;s+=1)for(let o=0;o<t;o+=1)n[t*s+o]=a[t*e[s]+o];return n}function ki({
geometry:a,bodies:e},t){let[r,n,s]=t.axes,o=(e?.lights??[]).slice(0,Us),i=o.map(({way:l,turns:h})=>{let u=A(A(k(r,l[0]),
n,l[1]),s,-l[2]);return F(a.frame,h?u:l)}),c=l=>Float32Array.from({length:3*Us},(h,u)=>l.flat()[u]??0);return{u_lightWays:c(
i),u_lightColours:c(o.map(({color:l})=>l))}}var Rt=class{graphics;header;parts;drawn=null;constructor(e,t,r){this.graphics=
e,this.header=t,this.parts=r}get labels(){return this.header.bodies?.labels??[]}get runs(){let{bodies:e}=this.header;return e&&
Ce.every(t=>this.parts.has(t))?e.runs:[]}get areBehind(){return this.runs.length>0&&this.header.opacity<1}get programs(){
let{programs:e}=this.graphics,{bodyVertex:t,bodyFragment:r,lineVertex:n,lineFragment:s}=this.header.shaders;return[e.get(
t,r),e.get(n,s,"FLOWTEX_BODY"),e.get(t,r,"FLOWTEX_HIDING")]}get isReady(){return!this.runs.length||this.programs.every(({
ready:e})=>e)}dispose(){let{drawn:e,graphics:t}=this;if(e){for(let r of e.buffers)t.free("Buffer",r);t.free("VertexArray",
e.faces),t.free("VertexArray",e.pieces),this.drawn=null}}seeThrough(e,t=this.areBehind){if(!this.runs.length)return e();
let r=this.graphics.context;r.enable(r.POLYGON_OFFSET_FILL),r.polygonOffset(Te[0],Te[0]),t&&(r.enable(r.BLEND),r.blendColor(
0,0,0,this.header.opacity),r.blendFuncSeparate(r.CONSTANT_ALPHA,r.ONE_MINUS_CONSTANT_ALPHA,r.ZERO,r.ONE)),e(),r.disable(
r.BLEND),r.disable(r.POLYGON_OFFSET_FILL)}draw({camera:e,anchor:t,width:r,height:n,ratio:s},o){let i=o==="clear",c=this.
runs.filter(({clear:_})=>_===i);if(!c.length)return;let{header:l,graphics:h}=this,{geometry:u}=l,m=h.context,[p,f]=this.
programs,d=this.drawn??=this.make(),g=z(u,e,t),[b,y,x,v]=e.eye,w=F(u.frame,E([b,y,x],k(u.center,v)));i&&(m.enable(m.BLEND),
m.blendFuncSeparate(m.SRC_ALPHA,m.ONE_MINUS_SRC_ALPHA,m.ZERO,m.ONE),m.depthMask(!1)),h.programs.use(p,{u_matrix:g,u_anchor:t,
u_eye:[...E(w,k(t,v)),v],...ki(l,e)}),m.bindVertexArray(d.faces),m.enable(m.POLYGON_OFFSET_FILL),m.polygonOffset(Te[1],Te[1]);
for(let{faces:[_,S],ambient:R,diffuse:L}of c)S&&(h.programs.use(p,{u_ambient:R,u_diffuse:L}),m.drawElements(m.TRIANGLES,
3*S,m.UNSIGNED_INT,12*_));m.disable(m.POLYGON_OFFSET_FILL);let M={u_matrix:g,u_anchor:t,u_picture:[r,n],u_horizon:[0,0,0,
1]};h.programs.use(f,M),m.bindVertexArray(d.pieces);for(let{pieces:[_,S],width:R}of c)if(S){h.programs.use(f,{u_width:R*
s});for(let[L,V,I,J,se]of[[d.ends,3,m.FLOAT,Pi,0],[d.colours,4,m.UNSIGNED_BYTE,Ri,2]]){m.bindBuffer(m.ARRAY_BUFFER,L);for(let U of[
0,1])m.vertexAttribPointer(se+U,V,I,V===4,J,J*(_+U/2))}m.drawArraysInstanced(m.TRIANGLE_STRIP,0,4,S)}m.bindVertexArray(null),
m.depthMask(!0),m.disable(m.BLEND)}hide(e,t){let{runs:r,graphics:n}=this;if(!r.length)return;let s=n.context,o=this.drawn??=
this.make();s.enable(s.POLYGON_OFFSET_FILL),s.polygonOffset(Te[1],Te[1]),n.programs.use(this.programs[2],{u_matrix:e,u_anchor:t}),
s.bindVertexArray(o.faces);for(let{faces:[i,c],clear:l}of r)l||s.drawElements(s.TRIANGLES,3*c,s.UNSIGNED_INT,12*i);s.disable(
s.POLYGON_OFFSET_FILL),s.bindVertexArray(null)}drawLabels(e,{camera:t,anchor:r,width:n,height:s,ratio:o}){let{geometry:i}=this.
header,c=z(i,t,r);for(let{text:l,position:h,size:u,color:m,plate:p}of this.labels){let f=E(F(i.frame,E(h,i.center)),r),[
d,g,,b]=[0,1,2,3].map(S=>c[S]*f[0]+c[4+S]*f[1]+c[8+S]*f[2]+c[12+S]);if(b<=0)continue;let[y,x]=[(.5+.5*d/b)*n,(.5-.5*g/b)*
s],v=u*o,w=Li*v;e.font=`600 ${v}px system-ui, sans-serif`,e.textBaseline="middle";let[M,_]=[e.measureText(l).width+2*w,v+
2*w];e.fillStyle=Ds(p),e.beginPath(),e.roundRect(y,x-_,M,_,w),e.fill(),e.fillStyle=Ds(m),e.fillText(l,y+w,x-.5*_)}}make(){
let{graphics:e,parts:t}=this,r=e.context,[n,s,o,i,c]=Ce.map(b=>t.get(b)?.data??[]),l=()=>{let b=e.counted(r.createVertexArray());
return r.bindVertexArray(b),b},h=(b,y=r.ARRAY_BUFFER)=>{let x=e.counted(r.createBuffer());return r.bindBuffer(y,x),r.bufferData(
y,b,r.STATIC_DRAW),x},u=l(),p=[[n,3,r.FLOAT],[s,3,r.BYTE],[o,4,r.UNSIGNED_BYTE]].map(([b,y,x],v)=>{let w=h(b);return r.enableVertexAttribArray(
v),r.vertexAttribPointer(v,y,x,x!==r.FLOAT,0,0),w});p.push(h(i,r.ELEMENT_ARRAY_BUFFER));let f=l(),d=h(Ve(n,c,3)),g=h(Ve(
o,c,4));for(let b=0;b<4;b+=1)r.enableVertexAttribArray(b),r.vertexAttribDivisor(b,1);return r.bindVertexArray(null),{faces:u,
pieces:f,ends:d,colours:g,buffers:[...p,d,g]}}};function Ds([a,e,t,r=1]){return`rgb(${[a,e,t].map(n=>Math.round(255*n)).
join(" ")} / ${r})`}var Lt=["land","missing"];var Oi=.18;function Bs({background:a,earth:e}){let t=a??[1,1,1],r=e?.missingShare??0,n=T(t.map(s=>s**2.2),[.2126,.7152,.0722])>=
Oi?0:1;return t.map(s=>s*(1-r)+n*r)}var $s=1e30,Hs=65535,zs=256;function Fi(a,{low:e,size:t}){let r=[],n=[0,0,0];for(let s=0;s<a.length;s+=4){a[s+3]&&r.push(
[]);let o=n.map((i,c)=>(n[c]=n[c]+a[s+c]&Hs,e[c]+n[c]/Hs*t[c]));r[r.length-1].push(o)}return r}function Ni(a,e){return e?
a.flatMap(t=>{let r=0,n=t.filter((s,o)=>{let i=r;return o&&(r+=Math.hypot(...s.map((l,h)=>l-t[o-1][h]))),Math.floor(r/e)>
Math.floor(i/e)||o===0||o===t.length-1});return r<e?[]:[n]}):a}function Ii(a,e){let t=a.reduce((s,o)=>s+o.length+1,0),r=new Float32Array(
3*t).fill($s),n=0;for(let s of a){n+=3;for(let o of s)for(let i=0;i<3;i+=1)r[n++]=o[i]-e[i]}return r}function Ci(a){let e=[],
t=a.length/3-1;for(let r=0;r<t;r+=zs){let n=Math.min(zs,t-r),[s,o]=[[1/0,1/0,1/0],[-1/0,-1/0,-1/0]];for(let l=3*r;l<3*(r+
n+1);l+=1)a[l]!==Math.fround($s)&&(s[l%3]=Math.min(s[l%3],a[l]),o[l%3]=Math.max(o[l%3],a[l]));let i=s.map((l,h)=>(l+o[h])/
2),c=Math.hypot(...s.map((l,h)=>(o[h]-l)/2));e.push({first:r,count:n,middle:i,radius:c})}return e}function Vi(a,e){let t=[];
for(let{first:r,count:n,middle:[s,o,i],radius:c}of a){let l=([u,m,p,f])=>u*s+m*o+p*i+f<-c*Math.hypot(u,m,p);if(e.some(l))
continue;let h=t[t.length-1];h&&h[0]+h[1]===r?h[1]+=n:t.push([r,n])}return t}var Gs=12,Ws=2;var kt=class{version=0;graphics;header;parts;drawn=new Map;constructor(e,t,r){this.graphics=e,this.header=t,this.parts=r}forget(e){
this.version+=1;for(let t of e==="position"?Lt:[e])this.drop(t)}dispose(){for(let e of[...this.drawn.keys()])this.drop(e)}drop(e){
let t=this.drawn.get(e);if(t){for(let r of t.buffers)this.graphics.free("Buffer",r);this.graphics.free("VertexArray",t.array),
this.drawn.delete(e)}}get lines(){let{earth:e}=this.header;return e?Jr.filter(t=>e[t]&&this.parts.has(t)):[]}drawLines(e,t){
let{header:r,graphics:n}=this,{earth:s,shaders:o}=r,i=n.programs.get(o.lineVertex,o.lineFragment);if(!s||!i.ready)return;
let c=n.context,{camera:l,anchor:h,width:u,height:m,ratio:p}=e;c.bindFramebuffer(c.FRAMEBUFFER,null),c.viewport(0,0,u,m),
c.enable(c.SCISSOR_TEST),c.scissor(0,0,u,m),c.disable(c.DEPTH_TEST),c.enable(c.BLEND),c.blendEquation(c.MAX),c.clearColor(
0,0,0,0);let f=this.horizon(l),g=[...l.planes,...f?[f]:[]].map(w=>this.localPlane(w,h)),b=2*l.height*p/m,y=P(Math.sqrt(m/
p/s.usualHeight),...s.widthRange),x=s.spacingPixels*b,v=s.spacings.find(w=>w<=x)??0;for(let{option:w,color:M,opacity:_,width:S}of s.
strokes){if(!this.lines.includes(w))continue;c.clear(c.COLOR_BUFFER_BIT);let R=this.take(w,h,()=>this.linesOf(w,h,v),v);
n.programs.use(i,{u_matrix:z(r.geometry,l,h),u_picture:[u,m],u_width:S*y*p,u_lineColour:[...M,_],u_horizon:f?g[g.length-
1]:[0,0,0,1]}),c.bindVertexArray(R.array),c.bindBuffer(c.ARRAY_BUFFER,R.buffers[0]);for(let[L,V]of Vi(R.groups,g)){for(let I=0;I<
Ws;I+=1)c.vertexAttribPointer(I,3,c.FLOAT,!1,Gs,(L+I)*Gs);c.drawArraysInstanced(c.TRIANGLE_STRIP,0,4,V)}t()}c.bindVertexArray(
null),c.blendEquation(c.FUNC_ADD),c.disable(c.BLEND)}get isReady(){let{lineVertex:e,lineFragment:t}=this.header.shaders,
{earth:r}=this.header;return r?.land&&(r.map===null&&r.below&&!this.groundProgram("FLOWTEX_GLOBE").ready||this.hasCells&&
!this.groundProgram(...this.roundness).ready)?!1:!this.lines.length||this.graphics.programs.get(e,t).ready}groundProgram(...e){
let{groundVertex:t,groundFragment:r}=this.header.shaders;return this.graphics.programs.get(t,r,...e)}get hasCells(){return Lt.
some(e=>this.parts.has(e))}get roundness(){return this.header.earth?.map===null?["FLOWTEX_ROUND"]:[]}drawGround({camera:e,
anchor:t}){let{header:r,graphics:n}=this,{earth:s,geometry:o}=r;if(!s?.land)return;let i=s.map===null,c=Lt.filter(p=>this.
parts.has(p)),l=n.context,h={u_matrix:z(o,e,t),u_ground:r.background??[1,1,1],u_lit:r.lighting,u_toEye:F(o.frame,k(e.axes[2],
-1))},u=Bs(r);if(i&&s.below){let p=this.groundProgram("FLOWTEX_GLOBE");if(!p.ready)return;n.programs.use(p,{...h,u_colour:u,
...this.disc(e,s.radius,t)}),l.bindVertexArray(this.take("disc",t,()=>this.emptyArray()).array),l.drawArrays(l.TRIANGLE_STRIP,
0,4)}let m=this.groundProgram(...this.roundness);if(!c.length||!m.ready)return l.bindVertexArray(null);l.depthMask(!1);for(let p of c){
let f=p==="land"?s.land:u,d=E(F(o.frame,k(o.center,-1)),t);n.programs.use(m,{...h,u_colour:f,...i&&{u_middle:d}});let g=this.
take(p,t,()=>this.cellsOf(p,t));l.bindVertexArray(g.array),l.drawElements(l.TRIANGLES,g.count,l.UNSIGNED_INT,0)}l.depthMask(
!0),l.bindVertexArray(null)}horizon(e){let{earth:t}=this.header;if(!t||t.map)return null;let{radius:r}=t,[n,s,o,i]=e.eye,
c=i*Math.hypot(n,s,o);return[...C([n,s,o]),c?-(r**2)/c:0]}localPlane(e,t){let{frame:r,center:n}=this.header.geometry,s=e.
slice(0,3),o=F(r,s);return[...o,T(o,t)+T(s,n)+e[3]]}disc(e,t,r){let{frame:n,center:s}=this.header.geometry,[o,i,c,l]=this.
horizon(e)??[0,0,1,0],h=[o,i,c],u=Math.sqrt(Math.max(t**2-l**2,0)),m=C(N(e.axes[1],h)),p=N(h,m),f=A(k(h,-l),s,-1);return{
u_middle:E(F(n,f),r),u_aside:k(F(n,m),u),u_upward:k(F(n,p),u),u_away:e.state.parallel?0:O(e.state.position)/t}}take(e,t,r,n=0){
let s=this.drawn.get(e);if(s&&String([s.anchor,s.spacing])===String([t,n]))return s;this.drop(e);let o={...r(),anchor:t,
spacing:n};return this.drawn.set(e,o),o}emptyArray(){let{graphics:e}=this;return{array:e.counted(e.context.createVertexArray()),
buffers:[],anchor:[0,0,0],spacing:0,count:0,groups:[]}}buffer(e,t){let{graphics:r}=this,n=r.context,s=r.counted(n.createBuffer());
return n.bindBuffer(e,s),n.bufferData(e,t,n.STATIC_DRAW),s}linesOf(e,t,r){let n=this.graphics.context,{earth:s}=this.header,
o=this.parts.get(e)?.data??[],i=s?Fi(o,s):[],c=Ii(Ni(i,r),t),l={...this.emptyArray(),groups:Ci(c)};n.bindVertexArray(l.array),
l.buffers=[this.buffer(n.ARRAY_BUFFER,c)];for(let h=0;h<Ws;h+=1)n.enableVertexAttribArray(h),n.vertexAttribDivisor(h,1);
return l}cellsOf(e,t){let r=this.graphics.context,n=this.parts.get(e),s=this.parts.get("position"),o=this.emptyArray();if(!n||
!s)return o;let i=this.header.geometry.triangles?n.data:Ui(n);r.bindVertexArray(o.array);let c=dt(s.data,t);return o.buffers=
[this.buffer(r.ARRAY_BUFFER,c),this.buffer(r.ELEMENT_ARRAY_BUFFER,i)],o.count=i.length,r.enableVertexAttribArray(0),r.vertexAttribPointer(
0,3,r.FLOAT,!1,0,0),o}};function Ui({data:a,shape:[e,t]}){let r=[];for(let n=0;n<e*t;n+=1){if(!a[n])continue;let s=n+Math.
floor(n/t),o=s+t+1;r.push(s,s+1,o+1,s,o+1,o)}return Uint32Array.from(r)}var[Di,Bi]=[.01,.2],[re,js]=[4,24],Ys=9;function Xs(a,e,t){let r={lines:{"from saddle":[],"to saddle":[],"stable orbit":[],
"unstable orbit":[]},points:[]};for(let s=0;s<Math.min(a.length/re,t.points);s+=1){let o=a[re*s+3];(r.points[o]??=[]).push(
...[0,1,2].map(i=>a[re*s+i]))}let n=NaN;for(let s=0;s<e.length/re;s+=1){let o=e[re*s+3];if(o>=et.saddle*t.saddles)continue;
let i=o&et.orbit?["stable orbit","unstable orbit"]:["from saddle","to saddle"],c=r.lines[i[o&et.leaving?0:1]];o!==n&&c.push(
[]),n=o,c[c.length-1].push(...[0,1,2].map(l=>e[re*s+l]))}return r}function Hi(a,e){let t=[];for(let r=0;r<a.length;r+=re)
a[r+3]===e&&t.push(a[r],a[r+1],a[r+2]);return Float32Array.from(t)}function Ue(a,e=!1){let t=Float32Array.from(a.flat());
if(e)return Ve(t,Array.from({length:2*t.length/3},(s,o)=>o>>1),3);let r=[],n=0;for(let s of a){let o=s.length/3;for(let i=n;i<
n+o-1;i+=1)r.push(i,i+1);n+=o}return Ve(t,r,3)}var Ot=class{graphics;header;parts;array=null;buffer=null;drawn=null;constructor(e,t,r){
this.graphics=e,this.header=t,this.parts=r}kinds(e){let t=this.header.structure?.parts??[];return Object.keys(Me).filter(
r=>t.includes(r)&&Number(e[Me[r]])>0)}lacking(e,t){let r=kr(t);return this.kinds(e).flatMap(n=>this.parts.has(`${n}/${r}`)?
[]:[[n,r]])}get program(){let{lineVertex:e,lineFragment:t}=this.header.shaders;return this.graphics.programs.get(e,t,"FL\
OWTEX_BODY","FLOWTEX_MARK")}isReady(e){return!this.kinds(e).length||this.program.ready}shown(e,t,r){let s=this.kinds(e).
includes(r)?this.parts.get(`${r}/${kr(t)}`):void 0;return[s?Number(e[Me[r]]):0,s]}legend(e,t){let[r,n]=this.shown(e,t,"c\
ritical"),s=new Set;for(let m=0;m<Math.min(r,n?.shape[0]??0);m+=1)s.add(Number(n?.data[re*m+3]));let{kinds:o=[],lines:i={},
nullclines:c=[]}=this.header.structure??{},[l,h]=this.shown(e,t,"separatrices"),u=Object.entries(Xs([],h?.data??[],{points:0,
saddles:l}).lines).filter(([,m])=>m.length).map(([m])=>({name:m,color:i[m]}));return this.shown(e,t,"nullclines")[0]&&u.
push(...c),[...o.filter((m,p)=>s.has(p)),...u.map(m=>({...m,isLine:!0}))]}draw({camera:e,anchor:t,width:r,height:n,ratio:s},o,i){
let{header:c,graphics:l}=this,{structure:h,geometry:u}=c,m=h&&this.layers(h,o,i);if(!h||!m?.length)return;let p=l.context,
[f,d,g,b]=e.eye,y=F(u.frame,E([f,d,g],k(u.center,b))),x=s*P(Math.sqrt(n/s/h.usualHeight),...h.widthRange),v=b?1:e.distance/
Math.hypot(...y);p.bindVertexArray(this.array),p.enable(p.BLEND),p.blendFuncSeparate(p.SRC_ALPHA,p.ONE_MINUS_SRC_ALPHA,p.
ZERO,p.ONE),p.depthFunc(p.LEQUAL);let w=this.program;l.programs.use(w,{u_matrix:z(u,e,t),u_anchor:t,u_eye:[...E(y,k(t,b)),
b],u_picture:[r,n],u_horizon:[0,0,0,1]}),p.bindBuffer(p.ARRAY_BUFFER,this.buffer);for(let{first:M,count:_,color:S,width:R,
above:L}of m){let[V,I,J,se=1]=S;l.programs.use(w,{u_width:R*x,u_nearer:Di*v*(1+Bi*L)});for(let U of[0,1])p.vertexAttribPointer(
U,3,p.FLOAT,!1,js,js*(M+U/2)),p.vertexAttrib4f(2+U,V,I,J,se);p.drawArraysInstanced(p.TRIANGLE_STRIP,0,4,_)}p.bindVertexArray(
null),p.depthFunc(p.LESS),p.disable(p.BLEND)}layers(e,t,r){let[[n,s],[o,i],[,c]]=["critical","separatrices","nullclines"].
map(w=>this.shown(t,r,w)),l=JSON.stringify([n,s?.digest,o,i?.digest,c?.digest,kr(r)]);if(this.drawn?.key===l)return this.
drawn.layers;let h=Xs(s?.data??[],i?.data??[],{points:n,saddles:o}),{line:u,dot:m,rim:p,middle:f}=e,d=[],g=[],b=0,y=(w,M,_,S)=>{
let R=w.length/6;R&&d.push({first:b,count:R,color:M,width:_,above:S}),g.push(w),b+=R},x=e.nullclines.map((w,M)=>Hi(c?.data??
[],M));x.forEach(w=>y(w,p,u[0],0)),x.forEach((w,M)=>y(w,e.nullclines[M].color,u[1],1)),y(Ue(Object.values(h.lines).flat()),
p,u[0],1.5),Object.entries(h.lines).forEach(([w,M],_)=>y(Ue(M),e.lines[w],u[1],2+_));let v=e.kinds.map((w,M)=>h.points[M]??
[]);return y(Ue(v,!0),p,m[0],6),e.kinds.forEach(({color:w},M)=>y(Ue([v[M]],!0),w,m[1],7)),y(Ue(v.filter((w,M)=>e.kinds[M].
turns),!0),f,m[2],8),this.send(g),this.drawn={key:l,layers:d},d}send(e){let{graphics:t}=this,r=t.context;this.array??=t.
counted(r.createVertexArray()),this.buffer??=t.counted(r.createBuffer()),r.bindVertexArray(this.array),r.bindBuffer(r.ARRAY_BUFFER,
this.buffer),r.bufferData(r.ARRAY_BUFFER,Float32Array.from(e.flatMap(n=>[...n])),r.STATIC_DRAW);for(let n of[0,1])r.enableVertexAttribArray(
n),r.vertexAttribDivisor(n,1);r.bindVertexArray(null)}at({place:e,position:t,height:r},n,s,o){let{geometry:i,structure:c}=this.
header,[l,h]=this.shown(s,o,"critical"),u=2*n.height/Math.max(r,1),[m,p]=["",Ys];for(let f=0;f<Math.min(l,h?.shape[0]??0);f+=
1){let[d,g,b,y]=[0,1,2,3].map(M=>Number(h?.data[re*f+M])),x=A(K(i.frame,[d,g,b]),i.center),v=n.project(x);if(!v||Math.hypot(
...E(x,t))>4*Ys*u)continue;let w=.5*r*Math.hypot((v[0]-e[0])*n.aspect,v[1]-e[1]);w<p&&([m,p]=[c?.kinds[y]?.name??"",w])}
return m}dispose(){this.graphics.free("Buffer",this.buffer),this.graphics.free("VertexArray",this.array),this.array=this.
buffer=this.drawn=null}};function kr([a,e,t]){return t<.5?a:e}var zi={position:["nodes"],normal:["nodes"],cells:["cells"],triangles:["nodes","cells","scalar"],blocks:["cells"],cmap:[
"cmap"],image:["image"],step:["step"],scalars:["scalar"]},qs=["padded","unit","open","nearest","rays"],Gi=8*(4/3),Wi=2048,
$i=["u_slices","u_slicesNext","u_image","u_stepImage","u_nodes"],ji=0,_e=class{graphics;header;parts;earth;bodies;arrows;marks;tile;anchor=[
0,0,0];version=0;resources=new Map;scalarSteps="";most=null;tracing="";wanted=[];number=ji+=1;constructor(e,t,r,n=null){
this.tile=n,this.graphics=e,this.header=t,this.parts=r,this.earth=new kt(e,t,r),this.bodies=new Rt(e,t,r),this.arrows=new Pt(
e,t,r),this.marks=new Ot(e,t,r)}isReady(e,t=!1){let r=[!1,!0].map(i=>this.arrows.program(e,i));return[...["place","surfa\
ce","smooth","probe"].filter(i=>t||i!=="smooth").map(i=>this.programs(i).ready),this.earth.isReady,this.bodies.isReady,this.
marks.isReady(e)].every(Boolean)&&r.every(i=>i?.ready??!0)}missing(e,t){let{geometry:r,slices:n,scalars:s,image:o,pyramid:i,
formula:c}=this.header,{trace:l}=n,h=["mesh",...l?.parts??["position",...r.planar?[]:["normal"]]];i&&!c&&h.push("places"),
this.header.bodies?.runs.length&&h.push(...Ce),r.triangles&&h.push("triangles","blocks");for(let u of new Set([e,t]))l?h.
push(...oe(this.header,u).map(m=>`flow/${m}`)):h.push(`slices/${u}`),n.channels===2&&h.push(`extra/${u}`);return h.push(
...this.scalarParts(e,t)),s.name!==null&&h.push("cmap"),o&&h.push("image","step"),[...new Set(h)].filter(u=>!this.fits(u))}lacking(e){
let t=this.missing(e,e).map(r=>r.startsWith("flow/")?X(r):e);return[...new Set(t)]}scalarParts(e,t,r=this.header.scalars){
let{name:n,steps:s,number:o}=r;if(n===null)return[];let i=o?`/${o}`:"";return(s>1?[e,t]:[0,0]).map(c=>`scalars/${c}${i}`)}fits(e){
let t=this.parts.get(e);if(!t)return!1;let{geometry:r,slices:n,image:s,mesh:o}=this.header,i=r.shape.map(u=>Math.max(Math.
ceil((u-1)/o.tileCells),1)),c=n.trace?.nodes??[],h={flow:[...c,t.shape[2]],unit:c,padded:[...c.map(u=>u+2),3],slices:[n.
count,r.rows.size,r.columns.size,n.channels],position:[...r.shape,3],mesh:r.triangles?t.shape:[...i,t.shape[2]],step:s?[
...s.stepSize].reverse():[]}[e.split("/")[0]];return!h||String(h)===String(t.shape)}make(e,t){let{slices:r,geometry:n}=this.
header,{trace:s}=r;if(!s)return!0;let o=this.part("padded"),i=c=>this.key(["padded"],c,s);return this.put("position",i("\
position"),()=>Nn(o,s,n.shape)),!n.planar&&!s.parts.includes("normal")&&this.put("normal",i("normal"),()=>In(o,s,n.shape)),
this.wanted=e,e.every(c=>this.trace(c,t))}prepare(){let{trace:e}=this.header.slices;e&&st(this.graphics,this.header,e)}trace(e,t){
let{graphics:r,header:n}=this,{trace:s,lags:o,sides:i}=n.slices,c=`slices/${e}`;if(!s||this.resources.has(c))return!0;let l=oe(
n,e).map(m=>`flow/${m}`),h=this.key([...l,...qs],e,s,o,i,n.geometry.levels),u=null;if(!h||!r.common.has(`slices ${h}`)){
let{tracings:m}=r,p=h||`${this.number} ${e}`;this.tracing!==p&&this.stopTracing();let f=g=>this.parts.get(g),d=m.get(p)??
new at(r,n,s,f,e);if(m.set(this.tracing=p,d),u=d.advance(t),!u)return!1;this.stopTracing()}return this.take(c,"Texture",
h,()=>u,()=>{}),!0}put(e,t,r){let{graphics:n,parts:s}=this;if(s.get(e)?.digest===t)return;let o=n.stock.get(t)?.part??{...r(),
digest:t};n.release(s.get(e)),s.set(e,n.hold(o)),this.forget(e)}isMade(e){return!this.missing(e[0],e[e.length-1]).length&&
(!this.header.slices.trace||this.isLoaded(e))}stopTracing(){this.graphics.tracings.get(this.tracing)?.dispose(),this.graphics.
tracings.delete(this.tracing),this.tracing=""}part(e){let t=this.parts.get(e);if(!t)throw new Error(`the part "${e}" of \
the scene is missing`);return t}forget(e){let[t,r]=e.split("/");["position","cells","triangles"].includes(t)&&this.arrows.
forget();let n=["slices","extra","flow"].includes(t);!n&&t!=="scalars"&&(this.earth.forget(e),this.version+=1,this.most=
null),Ce.includes(t)&&this.bodies.dispose();for(let s of n?[`slices/${r}`]:zi[t]??[])this.drop(s);qs.includes(t)&&(this.
wanted=[],this.dropSlices(NaN,NaN))}drop(e){let t=this.resources.get(e);this.resources.delete(e),t&&(t.users-=1,!t.users&&
(this.graphics.free(t.kind,t.object),this.graphics.common.delete(t.key)))}dispose(){for(let e of[...this.resources.keys()])
this.drop(e);this.stopTracing(),this.earth.dispose(),this.bodies.dispose(),this.arrows.dispose(),this.marks.dispose()}key(e,...t){
let r=e.map(n=>this.parts.has(n)?this.part(n).digest:"none");return r.every(Boolean)?JSON.stringify([r,t]):""}take(e,t,r,n,s){
let o=this.resources.get(e);if(o)return o.object;let{graphics:i}=this,c=r&&`${e.split("/")[0]} ${r}`,l=c?i.common.get(c):
void 0,h=l?.object??i.counted(n()),u=l??{kind:t,object:h,count:0,key:c,users:0};return u.users+=1,this.resources.set(e,u),
l||(u.count=s(h)||0),c&&i.common.set(c,u),h}get blocks(){return this.part("mesh")}get doublings(){let{geometry:e,mesh:t}=this.
header;return this.most??=Es(e,this.blocks,this.part("position").data,t.tileCells)}cornersAt(e){let{triangles:t,shape:r}=this.
header.geometry;return t?Qn(this.part("triangles").data,e):Jn(r,e)}isLoaded(e){return e.every(t=>this.resources.has(`sli\
ces/${t}`))}get tracedBytes(){let{slices:e,geometry:t}=this.header;return e.trace?[...this.resources.keys()].filter(n=>n.
startsWith("slices/")).length*Gi*e.count*t.rows.size*t.columns.size:0}load(e){for(let t of e)this.slices(t)}bindNodes(e){
let t=this.graphics.context,{shape:r,triangles:n,planar:s}=this.header.geometry;e.some((u,m)=>u!==this.anchor[m])&&this.
drop("nodes"),this.anchor=e;let[o,i]=this.nodesSize,c=this.texture("nodes",this.key(["position","normal"],i,e),u=>{ur(t,
i,o),t.bindTexture(t.TEXTURE_2D_ARRAY,u);let m=new Float32Array((s?3:6)*i*o);m.set(dt(this.part("position").data,e)),s||
m.set(Kn(this.part("normal").data),3*i*o);let p=[i,o,s?1:2];t.texImage3D(t.TEXTURE_2D_ARRAY,0,t.RGB32F,...p,0,t.RGB,t.FLOAT,
m),Ks(t,t.TEXTURE_2D_ARRAY)}),l=()=>this.parts.get("cells")?.data??Uint8Array.of(1),h=n?this.table("cells",this.key(["tr\
iangles","blocks"]),t.RGBA32UI,Wi,()=>Zn(this.part("triangles").data,this.part("blocks").data)):this.table("cells",this.
key(["cells"],r),t.R8UI,this.parts.has("cells")?r[1]-1:1,l);this.bind("u_nodes",c),this.bind(n?"u_corners":"u_open",h)}get nodesSize(){
let{shape:e,triangles:t,rows:r,columns:n}=this.header.geometry;return t?[r.size,n.size]:e}bind(e,t){let r=this.graphics.
context;r.activeTexture(r.TEXTURE0+de.indexOf(e)),r.bindTexture($i.includes(e)?r.TEXTURE_2D_ARRAY:r.TEXTURE_2D,t),r.activeTexture(
r.TEXTURE0+de.length)}table(e,t,r,n,s){let o=this.graphics.context,i={[o.RGBA32UI]:[o.RGBA_INTEGER,o.UNSIGNED_INT,4],[o.
R8UI]:[o.RED_INTEGER,o.UNSIGNED_BYTE,1],[o.RG32F]:[o.RG,o.FLOAT,2],[o.RGBA32F]:[o.RGBA,o.FLOAT,4]},[c,l,h]=i[r];return this.
texture(e,t,u=>{let m=s(),p=Math.ceil(m.length/h/n);o.bindTexture(o.TEXTURE_2D,u),o.pixelStorei(o.UNPACK_ALIGNMENT,1);let f=Yi(
m,h*n*p);o.texImage2D(o.TEXTURE_2D,0,r,n,p,0,c,l,f),Ks(o,o.TEXTURE_2D)})}shares(e,t){let{geometry:r,scalars:n}=this.header,
{shape:s}=r,o=this.scalarParts(e,t);return[this.key(["triangles",...new Set(o)],s,n.low,n.high,n.log),()=>gt(o.map(l=>this.
part(l).data),n)]}texture(e,t,r){let n=this.graphics.context;return this.take(e,"Texture",t,()=>n.createTexture(),r)}slices(e){
let{slices:t,geometry:r}=this.header,n=this.key([`slices/${e}`,`extra/${e}`],r.levels,t.extra);return this.texture(`slic\
es/${e}`,n,s=>{let o=this.part(`slices/${e}`),[i,c,l,h]=o.shape,u=o.data,m=this.parts.get(`extra/${e}`)?.data,p=c*l,f=d=>{
let g=u.subarray(d*p*h,(d+1)*p*h);if(h===4)return g;let b=new Uint16Array(4*p),y=t.extra.indexOf(d),x=y<0?null:m?.subarray(
y*p,(y+1)*p);for(let v=0;v<p;v+=1)b[4*v]=g[2*v],b[4*v+1]=g[2*v+1],x&&(b[4*v+3]=x[v]);return b};this.fill(s,{width:l,height:c,
layers:i,channels:4,levels:r.levels},f)})}programs(e){let{programs:t}=this.graphics,{vertex:r,place:n,fullVertex:s,surface:o,
probe:i}=this.header.shaders;return e==="smooth"?t.get(r,o,"FLOWTEX_SMOOTH"):e==="place"?t.get(r,n):t.get(s,e==="probe"?
i:o)}texels(e,t){let{graphics:r,header:n}=this,s=r.context,{slices:o,geometry:i}=n,c=i.columns.size,l=this.slices(e),h=()=>{
s.activeTexture(s.TEXTURE0),s.bindTexture(s.TEXTURE_2D_ARRAY,l),s.bindVertexArray(null);let p=t.flatMap(f=>[f%c,Math.floor(
f/c)]);r.programs.use(this.programs("probe"),{u_texels:p}),s.drawArrays(s.TRIANGLES,0,3)},u=r.numbers(h,t.length,o.count),
m=new Float32Array(u.buffer);return(p,f)=>{let[d,g,b,y]=m.subarray(4*(p*t.length+f));return[d,g,b,y]}}image(e,t){let r=this.
graphics.context;return this.texture(e,this.key([e],t),n=>{let{data:s,shape:o}=this.part(e),[i,c,l=1]=o,h=Math.floor(Math.
log2(Math.max(c,i))),u={width:c,height:i,layers:1,channels:l,levels:h};this.fill(n,u,()=>s);let m=p=>t[p]?r.REPEAT:r.CLAMP_TO_EDGE;
r.texParameteri(r.TEXTURE_2D_ARRAY,r.TEXTURE_WRAP_S,m(1)),r.texParameteri(r.TEXTURE_2D_ARRAY,r.TEXTURE_WRAP_T,m(0))})}fill(e,t,r){
let n=this.graphics.context,{width:s,height:o,layers:i,channels:c,levels:l}=t;Qe(n,e,t),n.pixelStorei(n.UNPACK_ALIGNMENT,
1);let h=c===1?n.RED:n.RGBA;for(let u=0;u<i;u+=1)n.texSubImage3D(n.TEXTURE_2D_ARRAY,0,0,0,u,s,o,1,h,n.HALF_FLOAT,r(u));l&&
n.generateMipmap(n.TEXTURE_2D_ARRAY)}dropSlices(e,t){let r=t+1<this.header.slices.steps?t+1:0,n=[e,t,r,t+1,...this.wanted];
for(let s of[...this.resources.keys()])s.startsWith("slices/")&&!n.includes(X(s))&&this.drop(s)}bindTextures(e,t){let r=this.
graphics.context,{image:n,scalars:s}=this.header,o=String(this.scalarParts(e,t));o!==this.scalarSteps&&this.drop("scalar"),
this.scalarSteps=o,this.dropSlices(e,t),this.bind("u_slices",this.slices(e)),this.bind("u_slicesNext",t===e?null:this.slices(
t)),this.bind("u_image",n&&this.image("image",[!0,!0])),this.bind("u_stepImage",n&&this.image("step",n.repeat));let i=gn(
this.parts.get("cmap")?.data??new Uint8Array(4),s);this.bind("u_cmap",this.table("cmap",this.key(["cmap"],s.beyond),r.RGBA32F,
i.length/4,()=>i));let[c,l]=this.shares(e,t);this.bind("u_shares",s.name===null?null:this.table("scalar",c,r.RG32F,this.
nodesSize[1],l));let h=()=>qn(n?.alongI??[],n?.alongJ??[]);this.bind("u_along",n&&this.table("along","",r.RG32F,Math.max(
n.alongI.length,n.alongJ.length),h))}};function Ks(a,e){a.texParameteri(e,a.TEXTURE_MIN_FILTER,a.NEAREST),a.texParameteri(
e,a.TEXTURE_MAG_FILTER,a.NEAREST)}function Yi(a,e){if(a.length===e)return a;let t=new a.constructor(e);return t.set(a),t}var Xi=60,qi=25,Ki=9e8,Ji=3.5,Zi={slices:4,flow:24},Ft=class{layers=[];missing=[];wanted=0;pending=0;host;root;tiles=new Map;pyramid=null;chosen={
choices:new Map,steps:[],names:""};count=0;isWaiting=!1;hasAsked=!1;isOver=!1;failed=new Ae;constructor(e,t){this.host=e,
this.root=t}has(e,t){return this.tiles.get(e)?.parts.has(t)??!1}fail(e,t){this.failed.add(this.need(e,t)),this.host.refine()}need(e,t){
return`${e} ${t} ${this.root.header.scalars.name}`}dispose(){this.isOver=!0;for(let e of[...this.tiles.keys()])this.drop(
e)}setPart(e,t){let{graphics:r,header:n}=this.root,s=this.tiles.get(e)??this.emptyTile();if(this.tiles.set(e,s),t.digest&&
s.parts.get(t.name)?.digest===t.digest)return;if(r.release(s.parts.get(t.name)),s.parts.set(t.name,r.hold(t)),t.name==="\
header"){let l=JSON.parse(new TextDecoder().decode(t.data));s.scene?.dispose(),l&&(l.geometry.reach=n.geometry.reach),s.
scene=l&&new _e(r,{...n,...l,pyramid:null,bodies:null,structure:null},s.parts,ie(e)),this.giveMap(s)}else s.scene?.forget(
t.name);let{names:o,steps:i}=this.chosen;this.missing=this.missing.filter(l=>!this.isHere(l,i));let c=Er(this.chosen.choices,
l=>this.isHere(l,i));String([...c.keys()])!==o&&this.host.refine()}recolour(e={}){let{steps:t}=this.chosen;for(let r of this.
tiles.values()){let{scene:n,parts:s}=r;if(!n||(Object.assign(n.header,e),this.giveMap(r),n.forget("scalars"),(t.length?n.
scalarParts(t[0],t[t.length-1]):[]).every(c=>s.has(c))))continue;let i=[...s.keys()].filter(c=>c.startsWith("scalars/"));
for(let c of i)this.release(r,c)}}emptyTile(){return{parts:new Map,scene:void 0,used:this.count}}giveMap({scene:e,parts:t}){
let r=this.root.parts.get("cmap");r&&t.set("cmap",r),e?.forget("cmap")}arrange([e,t]){let{camera:r}=this.host;if(!r)return[];
let n=this.choose(r,[...new Set([e,t])]);return this.layers=[B,...[...n.keys()].filter(s=>s!==B)].flatMap(s=>{let o=s===
B?this.root:this.tiles.get(s)?.scene,i=(n.get(s)??[]).flatMap(l=>this.pyramid?[this.pyramid.finerPart(ie(l),s)]:[]),c=s===
B?[this.root.header.pyramid?.depth??0,0,0]:ie(s);return o?[{scene:o,key:c,covered:i}]:[]}),this.layers}choose(e,t){let{header:r}=this.
root,{settings:n,canvas:s,ratio:o}=this.host;if(!r.pyramid)return new Map;this.pyramid??=new mt(r.pyramid,Dn(r)??this.root.
part("places").data);let i=this.pyramid.choose({...e.sight(s.height/o),planes:e.planes,cellPixels:Hn(r.pyramid,n),shownOn:this.
host.shownOn});this.count+=1;for(let u of i.keys()){let m=this.tiles.get(u);m&&(m.used=this.count)}let c=performance.now()+
qi,l=this.obtainable(zn(i),t,r.pyramid.depth);this.missing=l.filter(u=>!this.isHere(u,t)),this.ask(),this.trim(t);for(let u of l)
this.isHere(u,t)&&this.load(u,t,c);let h=Er(i,u=>this.isHere(u,t)&&this.load(u,t,c));return this.wanted=l.length,this.pending=
l.filter(u=>!this.isHere(u,t)||!this.isLoaded(u,t)).length,this.chosen={choices:i,steps:t,names:String([...h.keys()])},h}obtainable(e,t,r){
let n=[t,...t.map(i=>[i])],s=i=>n.some(c=>this.failed.has(this.need(i,c))),o=e.map(i=>{let[c,l,h]=ie(i);for(;c<r&&s(G([c,
l,h]));)[c,l,h]=[c+1,l>>1,h>>1];return c<r?G([c,l,h]):B});return[...new Set(o)].filter(i=>i!==B)}isHere(e,t){let r=this.
tiles.get(e)?.scene;return r===null||r?.missing(t[0],t[t.length-1]).length===0}isLoaded(e,t){let r=this.tiles.get(e)?.scene;
return r===null||(r?.isLoaded(t)??!1)}load(e,t,r){let n=this.tiles.get(e)?.scene;return!n||this.isLoaded(e,t)?!0:performance.
now()>r||!n.make(t,r)?(this.host.refine(),!1):(n.load(t),!0)}ask(){let{requests:e,lifetime:t}=this.host;this.isWaiting||
!(this.missing.length||this.hasAsked)||(this.isWaiting=!0,t.later(()=>{if(this.isWaiting=!1,this.isOver)return;this.hasAsked=
this.missing.length>0;let r=(o,i)=>this.tiles.get(o)?.scene?.lacking(i)??oe(this.root.header,i),n=this.missing.flatMap(o=>this.
chosen.steps.flatMap(i=>r(o,i))),s=[...new Set(n)].sort((o,i)=>o-i);e.wantTiles(this.missing.map(ie),s)},Xi))}trim(e){let t=0;
for(let[r,n]of[...this.tiles].sort(([,s],[,o])=>o.used-s.used)){let{parts:s,scene:o,used:i}=n,c=o?.header.slices.trace?"\
flow":"slices",l=[...s.keys()].filter(u=>u.startsWith(`${c}/`)),h=o?e.flatMap(u=>oe(o.header,u)):e;for(let u of l.slice(
0,Math.max(l.length-Zi[c],0))){let m=X(u);if(h.includes(m))continue;for(let f of[c,"extra"])this.release(n,`${f}/${m}`);
let p=[...s.keys()].filter(f=>Ee(f,m,this.root.header));for(let f of p)this.release(n,f)}for(let{data:u}of s.values())t+=
Ji*u.byteLength;t+=o?.tracedBytes??0,t>(this.host.options.source?.memory??Ki)&&i<this.count&&this.drop(r)}}drop(e){let t=this.
tiles.get(e);t?.scene?.dispose();for(let r of[...t?.parts.keys()??[]])this.release(t,r);this.tiles.delete(e)}release(e,t){
t!=="cmap"&&this.root.graphics.release(e?.parts.get(t)),e?.parts.delete(t)}};var Nt=class{scene=null;tiles=null;places=null;shown=null;view;renderer;next=[];isLate=!1;constructor(e){this.view=e,this.
renderer=new wt(e,this),!e.graphics.gl&&e.panel.fail("This browser has no WebGL2 with floating-point targets, which are \
needed to draw the picture.","Turn on hardware acceleration in its settings, or use a recent Firefox, Chrome or Safari.")}open(e){
let{view:t}=this;this.leave(),this.scene=new _e(t.graphics,e,t.parts),this.tiles=new Ft(t,this.scene),this.places=new vt(
t.graphics)}leave(){this.tiles?.dispose(),this.scene?.dispose(),this.places?.dispose(),this.tiles=this.scene=this.places=
null}dispose(){this.leave(),this.renderer.dispose()}restart(e){this.renderer.restart(e)}resize(e,t){this.renderer.resize(
e,t)}refine(){this.renderer.refine()}arrange(e){let t=this.tiles?.arrange(e)??[];return this.view.root.dataset.tiles=String(
this.tiles?.pending??0),t}get smooth(){let{header:e,options:t}=this.view;return t.smooth!==void 0||!e?t.smooth??!1:this.
program(e).price<En}get isComing(){return!!this.tiles?.missing.length}get lacking(){let[e,t]=this.view.player.moment;return this.
scene?.missing(e,t)??[]}missing(e){return[...new Set(e.flatMap(t=>this.scene?.lacking(t)??[]))]}make(e,t){return this.next=
e,!this.missing(e).length&&!!this.scene?.make(e,t)}available(e){let{view:t,scene:r,shown:n,lacking:s}=this,{header:o,player:i}=t;
if(!o||!r)return null;let c=i.moment,l=i.playing?[1,2].map(p=>(c[1]+p)%o.slices.steps):[],h=this.missing([c[0],c[1],...this.
next,...l]);h.length&&t.requests.hasSteps&&!t.options.isComing?.()&&t.requests.wantSteps(h);let u=!s.length&&r.make(c.slice(
0,2),e);this.isLate=!u;let m=t.requests.hasMarks?r.marks.lacking(t.settings,c):[];return t.options.isComing?.()||t.requests.
wantMarks(m),t.root.dataset.lacking=String(s.length+m.length||+!u),t.panel.wait(s,u,this.renderer.leavesOut,m.length>0),
t.panel.showKinds(r.marks.legend(t.settings,c)),u&&String(c.slice(0,2))!==String(n?.slice(0,2))&&(t.trim(),t.change()),u?
this.shown=c:(s.length||t.request(),n&&r.isMade(n.slice(0,2))?n:null)}program(e,t=this.isClose(e),r=!this.view.player.playing){
let{fullVertex:n,fragment:s}=e.shaders,o=Un(e,this.view.settings,t,r);return this.view.graphics.programs.get(n,s,...o)}isClose(e){
let{view:t}=this;if(!t.camera)return!1;let r=t.view([0,0,0],t.ratio),n=this.tiles?.layers.slice(1).map(({scene:s})=>s.header)??
[];return(n.length?n:[e]).some(s=>lt(s,t.settings,r))}frame(e,t){let{view:r,scene:n}=this,{graphics:s,header:o}=r;if(s.isLost||
!s.gl||!r.isVisible||!o||!n||r.canvas.width<2)return;this.next=[],r.advance(e);let i=this.available(t);r.camera||r.place();
let c=this.program(o);if(n.prepare(),!i||!r.camera||this.isLate&&r.sharp)return;if(c.error)return r.panel.fail("The shad\
er does not compile with this graphics driver.",c.error);if(!c.ready||!n.isReady(r.settings,this.smooth))return r.request();
let l=!r.sharp&&this.renderer.draw(c,i,t);l&&(o.slices.critical&&this.program(o,!0),r.player.varies&&this.program(o,this.
isClose(o),!1)),r.painted(l)}get canPick(){return!!this.places?.width&&!this.view.graphics.isLost}find(e,t){let{tiles:r,
shown:n,scene:s,view:o}=this,{camera:i}=o,c=r?.layers.length&&n?this.renderer.placeAt(n,e,t):null;if(!c||!i||!n||!s)return null;
let l=ws(c,s,i,n,[e,t]),h={place:[e,t],position:l.point.position,height:o.root.clientHeight};return l.point.mark=s.marks.
at(h,i,o.settings,n),l}};var Or=class{canvas=document.createElement("canvas");root=document.createElement("div");graphics=kn();lifetime=new it;held=new ot(
this.graphics);parts=this.held.all;camera=null;sharp=!1;isVisible=!0;isClear=!1;shownOn=null;dispose(){this.lifetime.isOver||
(this.lifetime.end(),this.requests.stop(),this.painter.dispose?.(),this.held.clear(),this.graphics.leave(this))}get scene(){
return this.painter.scene??null}get tiles(){return this.painter.tiles??null}setPart(e){let t=me(e.name);return t&&this.tiles?.
setPart(t[0],{...e,name:t[1]}),t||!this.held.set(e)?!1:(this.scene?.forget(e.name),this.trim(),e.name==="cmap"&&this.tiles?.
recolour(),this.change(),!0)}lack(e,t,r=[]){t!==void 0&&this.tiles?.fail(t,r),this.tell(e)}trim(){this.held.trim(this.header,
this.options.source,this.player.moment.slice(0,2))}request(){!this.lifetime.isOver&&this.isVisible&&this.graphics.request(
this)}frame(e,t){if(!this.lifetime.isOver)try{this.painter.frame(e,t)}catch(r){this.fail(r)}}lost(){this.header&&this.painter.
open?.(this.header),this.sharp=!1}view(e,t){let{header:r,camera:n,player:s,rows:o}=this;if(!r||!n)throw new Error("no sc\
ene is shown yet");return jn({header:r,camera:n,anchor:this.scene?.anchor??[0,0,0],player:s,rows:o},e,t)}find(e,t){return this.
painter.canPick?this.painter.find?.(e,t)??null:null}},It=class extends Or{player;isClear=!0;panel;requests;options;header;settings;painter;ratio=1;host;isNew=!0;constructor(e,{
header:t,settings:r,player:n,source:s,isComing:o}){super(),this.host=e,this.header=t,this.settings=r,this.player=n,this.
options={source:s,isComing:o},this.panel={wait:()=>{},showKinds:()=>{},fail:(i,c)=>e.failed(i,c)},this.requests=new ft(s,
this),this.graphics.users.add(this),n.setHeader(t),this.painter=new Nt(this),this.requests.setHeader(t),this.painter.open(
t)}get isHeld(){return this.host.isHeld()}chooseColours(e){let{colours:t,part:r}=bn(this.header,e,this.parts);r&&this.setPart(
r),Object.assign(this.header,t),this.painter.scene?.forget("scalars"),this.tiles?.recolour(t),this.change()}look(e,t,r,n){
let{header:s,canvas:o}=this;this.ratio=n,this.camera=new fe(e,s.limits,s.geometry.planar,t/r);let i=[t,r].map(c=>Math.max(
Math.round(c*n),1));(i[0]!==o.width||i[1]!==o.height)&&this.painter.resize(i[0],i[1]),this.change(!0)}tell(e){this.host.
failed(e,"")}fail(e){this.player.playing=!1,this.host.failed("The flow cannot be drawn.",String(e))}place(){}advance(e){
let{player:t,painter:r}=this;!t.playing||!t.advance(e,n=>r.make(n,e))||(this.host.advanced(),this.change())}change(e=!1){
this.painter.restart(e),this.isNew=!0,this.refine()}refine(){this.isNew||this.painter.refine(),this.sharp=!1,this.request()}painted(e){
this.sharp=e&&!this.player.playing,(this.isNew||e)&&this.host.painted(e),this.isNew=!1,this.sharp||this.request()}get rows(){
return this.canvas.height/this.ratio}};var Js=`// A picture of the flow on a web map; nothing beside it.

in vec3 flowtexPlaceOut;
in vec2 flowtexSidesOut;

uniform vec4 u_box;
uniform mat4 u_flowMatrix;
uniform sampler2D u_flowPicture;
uniform float u_opacity;
uniform float u_flowPixel; // share of the box's width that a pixel of the picture covers
uniform bool u_repeated;   // whether the map goes on at its other side

// Pixels beside such a side into whose colour what is clear beyond may be mixed, which keeps this share at least.
const float FLOWTEX_EDGE = 4.0;
const float FLOWTEX_LEAST_SHARE = 0.2;
const float FLOWTEX_ROUNDED = 1e-6; // share of the width by which nodes of a scene are rounded

out vec4 flowtexOut;

void main()
{
  float pixel = max(max(fwidth(flowtexSidesOut.x), fwidth(flowtexSidesOut.y)), u_flowPixel);
  vec2 inside = max(max(0.5 * pixel, FLOWTEX_ROUNDED) - flowtexSidesOut, 0.0);
  vec3 seen = flowtexPlaceOut;
  if (u_repeated)
    seen += (inside.x - inside.y) * u_box.z * u_flowMatrix[0].xyw;
  vec2 place = 0.5 + 0.5 * seen.xy / seen.z;
  if (seen.z <= 0.0 || place != clamp(place, 0.0, 1.0))
    discard;
  vec4 colour = texture(u_flowPicture, place);
  float side = min(flowtexSidesOut.x, flowtexSidesOut.y);
  if (u_repeated && side < FLOWTEX_EDGE * pixel && colour.a > FLOWTEX_LEAST_SHARE)
    colour /= colour.a;
  flowtexOut = u_opacity * colour;
}
`;var Zs=`// A piece of a web map, in the cells of a grid over a box of a tile, and where it lies in a picture of the flow\
.
// \`projectTile\` is the map's.

uniform vec4 u_box;         // its corner and its size, in the tile's own units
uniform float u_mapCells;   // cells along a side of the grid
uniform mat4 u_flowMatrix;  // from the tile to the picture's clip space

out vec3 flowtexPlaceOut;   // as x, y and w
out vec2 flowtexSidesOut;   // ways to both sides of the box, as shares of its width

void main()
{
  vec2 cell = vec2(gl_VertexID >> 1, gl_InstanceID + (gl_VertexID & 1));
  vec2 place = u_box.xy + u_box.zw * cell / u_mapCells;
  flowtexPlaceOut = (u_flowMatrix * vec4(place, 0.0, 1.0)).xyw;
  flowtexSidesOut = vec2(cell.x, u_mapCells - cell.x) / u_mapCells;
  gl_Position = projectTile(place);
}
`;var Qs=64,Vt=.02,Ct=Math.PI/2;function ta(a){let e=tc(a),t=rc(a.half).map(l=>nc(e,l)),r=t.map(l=>sc(l,a.latitude)),n=r.map(
([l])=>l),s={seen:Math.max(...t.map(l=>Math.acos(Math.min(l[2],1)))),south:Math.min(...n),north:Math.max(...n),aside:Math.
max(...r.map(([,l])=>Math.abs(l)))},o=Vt*s.seen,i=ea(e,a,1)||s.north+o>Ct,c=ea(e,a,-1)||s.south-o<-Ct;return s.seen+=o,s.
north=i?Ct:s.north+o,s.south=c?-Ct:s.south-o,s.aside=i||c?Math.PI:Math.min((1+Vt)*s.aside,Math.PI),s}function tc({bearing:a,
pitch:e,away:t}){let r=[Math.sin(a),Math.cos(a),0],n=A(k(r,Math.sin(e)),[0,0,-Math.cos(e)]),s=A(k(r,Math.cos(e)),[0,0,Math.
sin(e)]);return{eye:A([0,0,1],n,-t),look:k(n,t),right:[r[1],-r[0],0],up:s}}function rc([a,e]){let t=[];for(let r=0;r<=Qs;r+=
1){let n=2*r/Qs-1;t.push([n*a,e],[n*a,-e],[a,n*e],[-a,n*e])}return t}function nc({eye:a,look:e,right:t,up:r},[n,s]){let o=C(
A(A(e,t,n),r,s)),i=-T(a,o),c=i**2-T(a,a)+1;if(c>0&&i>0)return A(a,o,i-Math.sqrt(c));let l=1/O(a),h=C(a),u=C(A(o,h,-T(o,h)));
return A(k(h,l),u,Math.sqrt(1-l**2))}function sc([a,e,t],r){let n=t*Math.sin(r)+e*Math.cos(r),s=t*Math.cos(r)-e*Math.sin(
r);return[Math.asin(Math.min(Math.max(n,-1),1)),Math.atan2(a,s)]}function ea({eye:a,look:e,right:t,up:r},{latitude:n,away:s,
half:o},i){let c=[0,i*Math.cos(n),i*Math.sin(n)],l=T(c,a)>=1-Vt,h=A(c,a,-1),u=T(h,e)/s**2,m=(1+Vt)*u;return l&&Math.abs(
T(h,t))<=m*o[0]&&Math.abs(T(h,r))<=m*o[1]}var Fr=1e-5,Ut=Math.atan(Math.sinh(Math.PI))*180/Math.PI,D=Math.PI/180,ac=88*D,ra='export it with projection="mercator"';
function ge({lng:a,lat:e}){let t=Math.sin(P(e,-Ut,Ut)*D);return[a/360+.5,.5-Math.atanh(t)/(2*Math.PI)]}function Bt(a){return 1/
Math.cos(P(a,-Ut,Ut)*D)}var Dt=class{origin;slope;box;constructor(e,t,r){let n=e?.map;if(!n||!t)throw new Error(`the flo\
w is not on a map; ${ra}`);let[s,o]=r??[n[0],n[2]];this.box=[s,n[1],o,n[3]];let[i,c]=t.shape,l=(x,v)=>{let[w,M,_]=t.data.
subarray(3*(x*c+v)),S=ge({lng:Math.atan2(M,w)/D,lat:Math.asin(_/Math.hypot(w,M,_))/D}),R=[n[0]+(n[2]-n[0])*v/(c-1),n[1]+
(n[3]-n[1])*x/(i-1)];return{place:S,position:R}},[h,u,m]=[l(1,1),l(i>>1,c>>1),l(i-2,c-2)],p=x=>x+Math.ceil(h.place[0]-x),
f=[p(m.place[0])-h.place[0],m.place[1]-h.place[1]];this.slope=[0,1].map(x=>f[x]/(m.position[x]-h.position[x])),this.origin=
[0,1].map(x=>h.place[x]-this.slope[x]*h.position[x]);let[d,g]=this.placeOf(u.position);if(!(Math.abs(d-p(u.place[0]))<Fr&&
Math.abs(g-u.place[1])<Fr))throw new Error(`the flow is on another map; ${ra}`);if(!r)return;this.slope=[1/(o-s),-1/(o-s)];
let y=[p(u.place[0]),u.place[1]];this.origin=[0,1].map(x=>y[x]-this.slope[x]*u.position[x])}placeOf(e){return[0,1].map(t=>this.
origin[t]+this.slope[t]*e[t])}lngLatOf(e){let[t,r]=this.placeOf(e);return[360*(t-.5),Math.atan(Math.sinh(2*Math.PI*(.5-r)))/
D]}positionOf(e){let[t,r]=e.map((s,o)=>(s-this.origin[o])/this.slope[o]),n=1/this.slope[0];return[t+n*Math.round((.5*(this.
box[0]+this.box[2])-t)/n),r]}look(e,t){let r=1/(512*2**e.zoom*this.slope[0]),[n,s]=this.positionOf(ge(e.center)),[o,,i]=this.
box,c=n+(n<.5*(o+i)?1:-1)/this.slope[0];if(e.globe)return this.globeLooks(e,r,[n,c,t]);let l=this.wholeLook(e,r,[n,s,t]);
if(l)return[l];let h=[this.flatLook(e,r,[n,s,t])],u=.5*r*Math.min(e.width,e.height),m=n-u<=o&&n+u>=i,p=r*sa(e);return!m&&
Math.abs(c-P(c,o,i))<p&&h.push(this.flatLook(e,r,[c,s,t])),h}get isAround(){let[e,,t]=this.box;return Math.abs((t-e)*this.
slope[0]-1)<Fr}globeLooks(e,t,[r,n,s]){let o=ta(oc(e,1/(t*this.slope[0]))),[i,,c]=this.box,l=.5*o.aside/(Math.PI*this.slope[0]),
u=!(r-l<=i&&r+l>=c)&&Math.abs(n-P(n,i,c))<l;return u&&this.isAround&&4*l>=c-i?[this.globeLook(e,t,{...o,aside:Math.PI},[
.5*(i+c),s])]:(u?[r,n]:[r]).map(p=>this.globeLook(e,t,o,[p,s]))}wholeLook(e,t,[r,n,s]){let[o,,i]=this.box;if(!this.isAround||
e.pitch>0)return null;let c=t*sa(e);if(r-c>o||r+c<i)return null;let{height:l}=e;e.bearing&&(l=2*c/t);let h=(i-o)/t;return this.
flatLook({...e,width:h,height:l,bearing:0},t,[.5*(o+i),n,s])}flatLook({width:e,height:t,bearing:r,pitch:n,fov:s},o,[i,c,
l]){let[h,u]=[r*D,n*D],m=.5*t*o,p=m/Math.tan(.5*s*D);return{state:{position:[i-p*Math.sin(u)*Math.sin(h),c-p*Math.sin(u)*
Math.cos(h),l+p*Math.cos(u)],focal_point:[i,c,l],up:[Math.sin(h),Math.cos(h),0],parallel:n===0,parallel_scale:m,view_angle:s},
width:e,height:t}}globeLook(e,t,r,[n,s]){let o=1/(t*this.slope[0]),[i,c]=[r.south,r.north].map(f=>ge({lng:0,lat:f/D})[1]),
l=(.5*(i+c)-this.origin[1])/this.slope[1],[h,u]=[r.aside/Math.PI,i-c],m={position:[n,l,s+1/this.slope[0]],focal_point:[n,
l,s],up:[0,1,0],parallel:!0,parallel_scale:.5*u/this.slope[0],view_angle:e.fov},p=new Nr(this,e.center,r.seen);return{state:m,
width:h*o,height:u*o,shownOn:p}}};function oc({center:a,width:e,height:t,bearing:r,pitch:n,fov:s},o){let i=o*Bt(a.lat)/(2*
Math.PI);return{latitude:a.lat*D,bearing:r*D,pitch:n*D,away:.5*t/Math.tan(.5*s*D)/i,half:[.5*e/i,.5*t/i]}}var Nr=class{mercator;middle;cosine;seen;constructor(e,{
lng:t,lat:r},n){this.mercator=e,this.middle=na(t,r),this.cosine=1/Bt(r),this.seen=n}sees(e){let[t,r,,n]=Array.from(e);return Math.
acos(P(T(na(...this.mercator.lngLatOf([t,r])),this.middle),-1,1))<=this.seen+this.angle(n)}scale(e){let[,t,,r]=Array.from(
e),n=Math.abs(2*Math.PI*(this.mercator.placeOf([0,t])[1]-.5)),s=Math.max(n-this.angle(r),0);return Math.min(1/Math.cosh(
s)/this.cosine,1)}angle(e){return 2*Math.PI*this.mercator.slope[0]*e}};function na(a,e){let t=Math.cos(e*D);return[t*Math.
cos(a*D),t*Math.sin(a*D),Math.sin(e*D)]}function sa({width:a,height:e,pitch:t,fov:r}){let[n,s]=[t*D,.5*r*D],o=n+s;if(o>ac)
return 1/0;let c=.5*e/Math.tan(s)*Math.cos(n)*(Math.tan(o)-Math.tan(n));return Math.hypot(c,.5*a*Math.cos(n)*Math.cos(s)/
Math.cos(o))}var Ir=8192,ic=22,aa=512,cc=[64,256],lc=.25,Ht=class{view;isUsed=!1;texture;shown=null;next=null;constructor(e,t){this.view=
t,this.texture=e.createTexture()}dispose(e){this.view.dispose(),e?.deleteTexture(this.texture)}follow(e,t){this.isUsed=this.
view.isVisible=e!==void 0,this.view.shownOn=e?.shownOn??null,e?this.view.look(e.state,e.width,e.height,t):this.shown=this.
next=null}painted(e){let{camera:t}=this.view;t&&this.isUsed&&(this.next={camera:t,isComplete:e})}get isComplete(){let{view:e,
next:t,shown:r}=this;return!this.isUsed||e.sharp&&!t&&!!r?.isComplete&&!e.tiles?.pending}upload(e,t){if(this.next){e.pixelStorei(
e.UNPACK_FLIP_Y_WEBGL,!0),e.pixelStorei(e.UNPACK_PREMULTIPLY_ALPHA_WEBGL,!0),e.texImage2D(e.TEXTURE_2D,0,e.RGBA,e.RGBA,e.
UNSIGNED_BYTE,this.view.canvas);for(let r of[e.TEXTURE_WRAP_S,e.TEXTURE_WRAP_T])e.texParameteri(e.TEXTURE_2D,r,e.CLAMP_TO_EDGE);
t&&e.generateMipmap(e.TEXTURE_2D),e.texParameteri(e.TEXTURE_2D,e.TEXTURE_MIN_FILTER,t?e.LINEAR_MIPMAP_LINEAR:e.LINEAR),e.
texParameteri(e.TEXTURE_2D,e.TEXTURE_MAG_FILTER,e.LINEAR),this.shown=this.next,this.next=null}}draw(e){let{gl:t,programs:r,
mercator:n,globe:s}=e,{vertexShaderPrelude:o,define:i}=e.shaderData,c=r.get(`${i}
${o}
${Zs}`,Js);if(!c.ready)return c.error;if(t.activeTexture(t.TEXTURE0),t.bindTexture(t.TEXTURE_2D,this.texture),this.upload(
t,s),!this.shown)return!0;let{camera:l}=this.shown,h=Math.floor(P(e.zoom,0,ic)),u=n.placeOf(l.state.focal_point),m=2**h,
p=[Math.floor(u[0]*m),P(Math.floor(u[1]*m),0,m-1)],f=Math.floor(p[0]/m),d={z:h,x:p[0]-f*m,y:p[1]},g=L=>L.map((V,I)=>(V*m-
p[I])*Ir),[b,y,x,v]=n.box,[w,M]=[[b,y],[x,v]].map(L=>g(n.placeOf(L)));t.bindVertexArray(e.array);let _=s?hc(e,Math.max(x-
b,v-y)*Math.abs(n.slope[0])):1,S=s?0:Math.round(ge(e.center)[0]-u[0]),R=0;e.isRepeated&&!s&&(R=Math.ceil(t.drawingBufferWidth/
(aa*2**e.zoom)));for(let L=-R;L<=R;L+=1){let V={wrap:f+S+L,canonical:d},I=e.getProjectionData({tileID:V,applyGlobeMatrix:s});
r.use(c,{u_projection_matrix:I.mainMatrix,u_projection_fallback_matrix:I.fallbackMatrix,u_projection_tile_mercator_coords:I.
tileMercatorCoords,u_projection_clipping_plane:I.clippingPlane,u_projection_transition:I.projectionTransition,u_box:[...w,
M[0]-w[0],M[1]-w[1]],u_mapCells:_,u_flowMatrix:uc(this.view.header,l,n,p,1/(m*Ir)),u_flowPicture:0,u_flowPixel:2*l.height/
this.view.canvas.height/(x-b),u_repeated:!!this.view.header.ends,u_opacity:e.opacity}),t.drawArraysInstanced(t.TRIANGLE_STRIP,
0,2*_+2,_)}return t.bindVertexArray(null),!0}};function hc({zoom:a,center:e},t){let n=aa*2**a*Bt(e.lat)/(2*Math.PI),s=t*
Math.PI*Math.sqrt(n/(2*lc));return P(Math.ceil(s),...cc)}function uc({geometry:a},e,t,r,n){let{center:s,frame:o}=a,{focal_point:i}=e.
state,c=F(o,E(i,s)),l=z(a,e,c),h=[0,1].map(f=>F(o,[0,1].map(d=>d===f?n/t.slope[f]:0).concat(0))),u=t.placeOf(i),m=[0,1].
map(f=>(r[f]*n*Ir-u[f])/t.slope[f]).concat(0);return[...h,[0,0,0],F(o,m)].flatMap((f,d)=>[0,1,2,3].map(g=>f.reduce((b,y,x)=>b+
l[4*x+g]*y,d===3?l[12+g]:0)))}var zt=class{atOnce=1;header;parts=[];tiles=new Map;known;texts;constructor(e,t,r,n){this.header=e,this.known=r,this.texts=
n;for(let s of t){let[{name:o,digest:i},c]=s,l=me(o)?.[0];l?this.tiles.set(l,[...this.tiles.get(l)??[],s]):this.parts.push(
s),l&&c&&n.set(i,c)}}load=(e,t)=>{let r=((e&&this.tiles.get(G(e)))??[]).filter(([{name:n}])=>{let s=me(n)?.[1]??"",o=X(s),
i=s.startsWith("scalars/")&&!Ee(s,o,this.header);return Number.isNaN(o)||t.includes(o)||i});return Promise.all(r.map(n=>this.
unpacked(n)))};async unpacked([e,t]){let{digest:r,name:n}=e,s=this.known.get(r);return s?{...s,name:n}:en(e,t||(this.texts.
get(r)??""))}async kept(e){let t=await this.unpacked(e);return this.known.set(t.digest,t),t}};var De=class{};var be=class extends Error{},q=class extends be{_tag="NotFoundError";name="NotFoundError";path;found;constructor(e,t={}){
super(`Not found: ${e}`,{cause:t.cause}),this.path=t.path,this.found=t.found}},H=class extends be{_tag="InvalidMetadataE\
rror";name="InvalidMetadataError";path;constructor(e,t={}){super(e,{cause:t.cause}),this.path=t.path}},Be=class extends be{_tag="\
UnknownCodecError";name="UnknownCodecError";codec;constructor(e){super(`Unknown codec: ${e}`),this.codec=e}},He=class extends be{_tag="\
CodecPipelineError";name="CodecPipelineError";direction;codec;chunkPath;constructor(e){let t=[`Failed to ${e.direction} \
chunk`,e.codec&&`via codec "${e.codec}"`,e.chunkPath&&`at ${e.chunkPath}`].filter(Boolean);super(t.join(" "),{cause:e.cause}),
this.direction=e.direction,this.codec=e.codec,this.chunkPath=e.chunkPath}};var ye=class extends be{_tag="UnsupportedError";name="UnsupportedError";feature;constructor(e){super(`Unsupported: ${e}`),
this.feature=e}};var ze=class{},Ge=class{},We=class{};function ia(){if(typeof SharedArrayBuffer>"u")throw new Error("SharedArrayBuffer is not available. In browsers, this req\
uires Cross-Origin-Opener-Policy and Cross-Origin-Embedder-Policy headers to be set.")}function ca(a,e){return e?new SharedArrayBuffer(
a):new ArrayBuffer(a)}function $e(a){let e=new TextDecoder().decode(a);try{return JSON.parse(e)}catch(t){throw new H("Fa\
iled to decode JSON",{cause:t})}}function Cr(a,e){let t=e/2,r=e-1,n=0;for(let s=0;s<a.length;s+=e)for(let o=0;o<t;o+=1)n=
a[s+o],a[s+o]=a[s+r-o],a[s+r-o]=n}function Wt(a){if(a==="v2:object")return globalThis.Array;let e=a.match(/v2:([US])(\d+)/);
if(e){let[,r,n]=e;return(r==="U"?We:Ge).bind(null,Number(n))}if(a==="string")return globalThis.Array;let t={int8:Int8Array,
int16:Int16Array,int32:Int32Array,int64:globalThis.BigInt64Array,uint8:Uint8Array,uint16:Uint16Array,uint32:Uint32Array,
uint64:globalThis.BigUint64Array,float16:globalThis.Float16Array,float32:Float32Array,float64:Float64Array,bool:ze}[a];if(!t)
throw new H(`Unknown or unsupported dataType: ${a}`);return t}function $t(a,e){let t=a.length;typeof e=="string"&&(e=e===
"C"?Array.from({length:t},(s,o)=>o):Array.from({length:t},(s,o)=>t-1-o)),pa(t===e.length,"Order length must match the nu\
mber of dimensions.");let r=1,n=new Array(t);for(let s=e.length-1;s>=0;s--)n[e[s]]=r,r*=a[e[s]];return n}function la({name:a,
configuration:e}){if(a==="default"){let t=e?.separator??"/";return r=>["c",...r].join(t)}if(a==="v2"){let t=e?.separator??
".";return r=>r.join(t)||"0"}throw new H(`Unknown chunk key encoding: ${a}`)}function oa(a){if(a==="|O")return{dataType:"\
v2:object"};let e=a.match(/^([<|>])(.*)$/);if(!e)throw new H(`Invalid dtype: ${a}`);let[,t,r]=e,n={b1:"bool",i1:"int8",u1:"\
uint8",i2:"int16",u2:"uint16",i4:"int32",u4:"uint32",i8:"int64",u8:"uint64",f2:"float16",f4:"float32",f8:"float64"}[r]??
(r.startsWith("S")||r.startsWith("U")?`v2:${r}`:void 0);if(!n)throw new H(`Unsupported or unknown dtype: ${a}`);return t===
"|"?{dataType:n}:{dataType:n,endian:t==="<"?"little":"big"}}function mc(a){return(a.id==="fixedscaleoffset"||a.id==="num\
codecs.fixedscaleoffset")&&typeof a.scale=="number"&&typeof a.offset=="number"&&(a.astype===void 0||typeof a.astype=="st\
ring")&&(a.dtype===void 0||typeof a.dtype=="string")}function ha(a,e={}){let t=[],r=oa(a.dtype);a.order==="F"&&t.push({name:"\
transpose",configuration:{order:"F"}});for(let s of a.filters??[]){if(s.id==="fixedscaleoffset"||s.id==="numcodecs.fixed\
scaleoffset"){if(!mc(s))throw new H(`Invalid fixedscaleoffset filter: ${JSON.stringify(s)}`);t.push({name:"scale_offset",
configuration:{scale:s.scale,offset:s.offset}});let c=s.astype??s.dtype;if(c!==void 0&&c!==a.dtype){let l=oa(c).dataType;
if(!Gt(l,"number")&&!Gt(l,"bigint"))throw new H(`fixedscaleoffset astype must be a numeric data type, got ${c}`);t.push(
{name:"cast_value",configuration:{data_type:l,rounding:"nearest-even",out_of_range:"wrap"}})}continue}let{id:o,...i}=s;t.
push({name:`numcodecs.${o}`,configuration:i})}if("endian"in r&&r.endian==="big"&&t.push({name:"bytes",configuration:{endian:"\
big"}}),a.compressor){let{id:s,...o}=a.compressor;t.push({name:`numcodecs.${s}`,configuration:o})}let n;return globalThis.
Array.isArray(e._ARRAY_DIMENSIONS)&&(n=e._ARRAY_DIMENSIONS),{zarr_format:3,node_type:"array",shape:a.shape,data_type:r.dataType,
chunk_grid:{name:"regular",configuration:{chunk_shape:a.chunks}},chunk_key_encoding:{name:"v2",configuration:{separator:a.
dimension_separator??"."}},codecs:t,fill_value:a.fill_value,dimension_names:n,attributes:e}}function ua(a,e={}){return{zarr_format:3,
node_type:"group",attributes:e}}function Gt(a,e){if(e!=="number"&&e!=="bigint"&&e!=="boolean"&&e!=="object"&&e!=="string")
return a===e;let t=a==="bool";if(e==="boolean")return t;let r=a.startsWith("v2:U")||a.startsWith("v2:S")||a==="string";if(e===
"string")return r;let n=a==="int64"||a==="uint64";if(e==="bigint")return n;let s=a==="v2:object";return e==="object"?s:!r&&
!n&&!t&&!s}function ma(a){return a?.name==="sharding_indexed"}function jt(a){if((a.data_type==="uint64"||a.data_type==="\
int64")&&a.fill_value!=null)return BigInt(a.fill_value);let e=a.data_type==="float16"||a.data_type==="float32"||a.data_type===
"float64";if(typeof a.fill_value=="string"&&e){let t={NaN:NaN,Infinity:1/0,"-Infinity":-1/0};if(a.fill_value in t)return t[a.
fill_value]}return a.fill_value}function Vr(a,...e){if(!e.some(t=>a instanceof t))throw a}function pa(a,e=""){if(!a)throw new Error(e)}async function fa(a,{
format:e,signal:t}){let r;if(a instanceof ArrayBuffer)r=new Response(a);else{let n=new Uint8Array(a.buffer,a.byteOffset,
a.byteLength);r=new Response(n.slice().buffer)}pa(r.body,"Response does not contain body.");try{return await new Response(
r.body.pipeThrough(new DecompressionStream(e),{signal:t})).arrayBuffer()}catch{throw t?.throwIfAborted(),new Error(`Fail\
ed to decode ${e}`)}}var da=pc();function pc(){let a=new Uint32Array([305419896]);return new Uint8Array(a.buffer,a.byteOffset,a.byteLength)[0]!==
18}function ga(a){return"BYTES_PER_ELEMENT"in a?a.BYTES_PER_ELEMENT:4}var je=class a{kind="array_to_bytes";#e;#t;#r;#s;#n;constructor(e,t){
this.#n=e?.endian,this.#t=Wt(t.dataType),this.#s=t.shape,this.#e=$t(t.shape,"C");let r=new this.#t(0);this.#r=r.BYTES_PER_ELEMENT}static fromConfig(e,t){
return new a(e,t)}encode(e){let t=new Uint8Array(e.data.buffer);return da&&this.#n==="big"&&(t=t.slice(),Cr(t,ga(this.#t))),
t}computeEncodedSize(e){return e}decode(e){return da&&this.#n==="big"&&(e=e.slice(),Cr(e,ga(this.#t))),e.byteOffset%this.#r!==
0&&(e=e.slice()),{data:new this.#t(e.buffer,e.byteOffset,e.byteLength/this.#r),shape:this.#s,stride:this.#e}}};var Yt=class{};function Xt(a){return()=>{throw new ye(`${a} encode`)}}var qt=class a{kind="bytes_to_bytes";static fromConfig(){return new a}encode=Xt("crc32c");decode(e){return new Uint8Array(
e.buffer,e.byteOffset,e.byteLength-4)}computeEncodedSize(e){return e+4}};var Kt=class{};var Jt=class a{kind="bytes_to_bytes";static fromConfig(e){return new a}encode=Xt("gzip");async decode(e){let t=await fa(
e,{format:"gzip"});return new Uint8Array(t)}};var Ye=class{};var Zt=class{};var Qt=class{};var er=class{};var Xe=class{};var tr=class{};function fc(){let a=()=>import("numcodecs/blosc").then(s=>s.default),e=()=>import("numcodecs/lz4").then(s=>s.default),t=()=>import("numcodecs/zstd").
then(s=>s.default),r=()=>Jt,n=()=>tr;return new Map().set("blosc",a).set("lz4",e).set("zstd",t).set("gzip",r).set("zlib",
n).set("transpose",()=>er).set("bytes",()=>je).set("crc32c",()=>qt).set("vlen-utf8",()=>Xe).set("json2",()=>Ye).set("bit\
round",()=>De).set("cast_value",()=>Yt).set("scale_offset",()=>Zt).set("numcodecs.blosc",a).set("numcodecs.lz4",e).set("\
numcodecs.zstd",t).set("numcodecs.gzip",r).set("numcodecs.zlib",n).set("numcodecs.vlen-utf8",()=>Xe).set("numcodecs.shuf\
fle",()=>Qt).set("numcodecs.delta",()=>Kt).set("numcodecs.bitround",()=>De).set("numcodecs.json2",()=>Ye)}var qe=fc();function Ke(a){
let e;function t(){return e||(e=dc(a)),e}async function r(n,s,o){try{return await o()}catch(i){throw new He({direction:n,
codec:s,cause:i})}}return{async encode(n){let s=await t();for(let{name:i,codec:c}of s.arrayToArray)n=await r("encode",i,
()=>c.encode(n));let o=await r("encode",s.arrayToBytes.name,()=>s.arrayToBytes.codec.encode(n));for(let{name:i,codec:c}of s.
bytesToBytes)o=await r("encode",i,()=>c.encode(o));return o},async decode(n){let s=await t();for(let i=s.bytesToBytes.length-
1;i>=0;i--){let{name:c,codec:l}=s.bytesToBytes[i];n=await r("decode",c,()=>l.decode(n))}let o=await r("decode",s.arrayToBytes.
name,()=>s.arrayToBytes.codec.decode(n));for(let i=s.arrayToArray.length-1;i>=0;i--){let{name:c,codec:l}=s.arrayToArray[i];
o=await r("decode",c,()=>l.decode(o))}return o},async computeEncodedSize(n){let s=await t(),o=ba(s.arrayToBytes.name,s.arrayToBytes.
codec,n);for(let{name:i,codec:c}of s.bytesToBytes)o=ba(i,c,o);return o}}}function ba(a,e,t){if(!e.computeEncodedSize)throw new H(
`Codec "${a}" cannot compute its encoded size; it is not a fixed-size codec and cannot be used in a sharding index pipel\
ine`);return e.computeEncodedSize(t)}async function dc(a){let e=a.codecs.map(async o=>{let i=await qe.get(o.name)?.();if(!i)
throw new Be(o.name);return{Codec:i,meta:o}}),t=[],r,n=[],s={...a};for await(let{Codec:o,meta:i}of e){let c=o.fromConfig(
i.configuration,s);switch(c.kind){case"array_to_array":t.push({name:i.name,codec:c}),c.getEncodedMeta&&(s=c.getEncodedMeta(
s));break;case"array_to_bytes":r={name:i.name,codec:c};break;default:n.push({name:i.name,codec:c})}}if(!r){if(!gc(s))throw new H(
`Cannot encode ${s.dataType} to bytes without a codec`);r={name:"bytes",codec:je.fromConfig({endian:"little"},s)}}return{
arrayToArray:t,arrayToBytes:r,bytesToBytes:n}}function gc(a){return a.dataType!=="v2:object"&&a.dataType!=="string"}var ya=18446744073709551615n;function xa(a,e,t,r){if(!a.store.getRange)throw new ye("sharding requires a store with getR\
ange");let n=a.store.getRange.bind(a.store),s=e.map((l,h)=>l/r.chunk_shape[h]),o=Ke({dataType:"uint64",shape:[...s,2],codecs:r.
index_codecs,fillValue:null}),i=16*s.reduce((l,h)=>l*h,1),c={};return async(l,h)=>{let u=l.map((v,w)=>Math.floor(v/s[w])),
m=a.resolve(t(u)).path;m in c||(c[m]=(async()=>{let v=await o.computeEncodedSize(i),w=await n(m,{suffixLength:v},h);return w?
await o.decode(w):null})().catch(v=>{throw delete c[m],v}));let p=await c[m];if(p===null)return;let{data:f,shape:d,stride:g}=p,
b=l.map((v,w)=>v%d[w]).reduce((v,w,M)=>v+w*g[M],0),y=f[b],x=f[b+1];if(!(y===ya&&x===ya))return n(m,{offset:Number(y),length:Number(
x)},h)}}var ne=class a{store;path;constructor(e,t="/"){this.store=e,this.path=t}resolve(e){let t=new URL(`file://${this.path.endsWith(
"/")?this.path:`${this.path}/`}`);return new a(this.store,decodeURIComponent(new URL(e,t).pathname))}};function nr(a){return new ne(
a??new Map)}var xe=class extends ne{kind="group";#e;constructor(e,t,r){super(e,t),this.#e=r}get attrs(){return this.#e.attributes}};
function va(a){return a.find(t=>t.name==="transpose")?.configuration?.order??"C"}function bc(a,e){let t=new Map(e.map((r,n)=>[
r,n]));return a.filter(r=>t.has(r)).map(r=>t.get(r))}function wa(a){return(e,t)=>{let r=globalThis.Array.isArray(a)&&t?bc(
a,t):a;return $t(e,r)}}var rr=Symbol("zarrita.context");function yc(a,e){let{configuration:t}=e.codecs.find(ma)??{},r={encodeChunkKey:la(e.chunk_key_encoding),TypedArray:Wt(e.data_type),
fillValue:e.fill_value};if(t){let s=va(t.codecs);return{...r,kind:"sharded",chunkShape:t.chunk_shape,codec:Ke({dataType:e.
data_type,shape:t.chunk_shape,codecs:t.codecs,fillValue:e.fill_value}),getStrides:wa(s),getChunkBytes:xa(a,e.chunk_grid.
configuration.chunk_shape,r.encodeChunkKey,t)}}let n=va(e.codecs);return{...r,kind:"regular",chunkShape:e.chunk_grid.configuration.
chunk_shape,codec:Ke({dataType:e.data_type,shape:e.chunk_grid.configuration.chunk_shape,codecs:e.codecs,fillValue:e.fill_value}),
getStrides:wa(n),async getChunkBytes(s,o){let i=r.encodeChunkKey(s),c=a.resolve(i).path;return a.store.get(c,o)}}}var le=class extends ne{kind="\
array";#e;[rr];constructor(e,t,r){super(e,t),this.#e={...r,fill_value:jt(r)},this[rr]=yc(this,this.#e)}get attrs(){return this.#e.
attributes}get dimensionNames(){return this.#e.dimension_names}get fillValue(){return this.#e.fill_value}get shape(){return this.#e.
shape}get chunks(){return this[rr].chunkShape}get dtype(){return this.#e.data_type}async getChunk(e,t,r){r?.useSharedArrayBuffer&&
ia();let n=this[rr],s=await n.getChunkBytes(e,t);if(!s){let o=n.chunkShape.reduce((c,l)=>c*l,1),i;if(r?.useSharedArrayBuffer){
let c=new n.TypedArray(0);if(!("BYTES_PER_ELEMENT"in c))console.warn("zarrita: useSharedArrayBuffer is not supported for\
 non-buffer-backed data types."),i=new n.TypedArray(o);else{let l=ca(o*c.BYTES_PER_ELEMENT,!0);i=new n.TypedArray(l,0,o)}}else
i=new n.TypedArray(o);return i.fill(n.fillValue),{data:i,shape:n.chunkShape,stride:n.getStrides(n.chunkShape)}}return n.
codec.decode(s)}is(e){return Gt(this.dtype,e)}};function Ma(a,e){let t=a;for(let r of e)t instanceof Promise?t=t.then(n=>r(n)):t=r(t);return t}function Ea(a,...e){return Ma(a,e)}async function Ta(a){let e=a.store.arrayExtensions;return e?.length?await Ea(a,...e):a}var sr=xc();function xc(){let a=new WeakMap;
function e(t){let r=a.get(t)??{v2:0,v3:0};return a.set(t,r),r}return{increment(t,r){e(t)[r]+=1},versionMax(t){let r=e(t);
return r.v3>r.v2?"v3":"v2"}}}async function vc(a,e){let t=await a.store.get(a.resolve(".zattrs").path,{signal:e});return t?
$e(t):{}}async function wc(a,e={}){let t="store"in a?a:new ne(a),{signal:r}=e,n={};return(e.attrs??!0)&&(n=await vc(t,r)),
r?.throwIfAborted(),e.kind==="array"?Sa(t,n,r):e.kind==="group"?Aa(t,n,r):Sa(t,n,r).catch(s=>(Vr(s,q,H),Aa(t,n,r)))}async function Sa(a,e,t){
let{path:r}=a.resolve(".zarray"),n=await a.store.get(r,{signal:t});if(!n)throw new q("v2 array",{path:r});return sr.increment(
a.store,"v2"),Ta(new le(a.store,a.path,ha($e(n),e)))}async function Aa(a,e,t){let{path:r}=a.resolve(".zgroup"),n=await a.
store.get(r,{signal:t});if(!n)throw new q("v2 group",{path:r});return sr.increment(a.store,"v2"),new xe(a.store,a.path,ua(
$e(n),e))}async function Mc(a,e){let{store:t,path:r}=a.resolve("zarr.json"),n=await a.store.get(r,{signal:e});if(!n)throw new q(
"v3 array or group",{path:r});let s=$e(n);return s.node_type==="array"&&(s.fill_value=jt(s)),s.node_type==="array"?Ta(new le(
t,a.path,s)):new xe(t,a.path,s)}async function Ec(a,e={}){let t="store"in a?a:new ne(a),r=await Mc(t,e.signal);if(sr.increment(
t.store,"v3"),e.kind===void 0||e.kind==="array"&&r instanceof le||e.kind==="group"&&r instanceof xe)return r;let n=r instanceof
le?"array":"group";throw new q(`${e.kind} at ${t.path}`,{path:t.path,found:n})}async function Q(a,e={}){let t="store"in a?
a.store:a,r=sr.versionMax(t),n=r==="v2"?Q.v2:Q.v3,s=r==="v2"?Q.v3:Q.v2;return n(a,e).catch(o=>(Vr(o,q,H),s(a,e)))}Q.v2=wc;
Q.v3=Ec;var _a=[300,1e3,3e3],Pa=2e4,Ac=[401,403,404,410],La=200,Tc=429,_c=500,Pc=2197175160,Ur=4,Rc=8,Lc=1<<28,$=class extends Error{fault;detail;constructor(e,t,r=t){
super(t),this.fault=e,this.detail=r}},kc=Array.from({length:4},(a,e)=>Uint32Array.from({length:256},(t,r)=>{let n=r;for(let s=0;s<
8*(e+1);s+=1)n=n>>>1^(n&1?Pc:0);return n}));function Oc(a){let[e,t,r,n]=kc,s=a.length-a.length%4,o=4294967295;for(let i=0;i<
s;i+=4)o^=a[i]|a[i+1]<<8|a[i+2]<<16|a[i+3]<<24,o=n[o&255]^r[o>>>8&255]^t[o>>>16&255]^e[o>>>24];for(let i=s;i<a.length;i+=
1)o=o>>>8^e[(o^a[i])&255];return~o>>>0}async function ka(a,e){let t=[],r=0,n=a?.getReader();try{for(;;){let{done:o=!0,value:i}=await n?.
read()??{};if(o||!i)break;t.push(i),r+=i.length,e(r)}}catch(o){throw n?.cancel().catch(()=>{}),o}let s=new Uint8Array(r);
return t.reduce((o,i)=>(s.set(i,o),o+i.length),0),s}var Dr=class a{kind="bytes_to_bytes";static fromConfig(){return new a}encode(){
throw new Error("nothing is written")}decode(e){let t=e.byteLength-Ur;if(t<0)throw new Error("the checksum is missing");
let{buffer:r,byteOffset:n}=e,s=new DataView(r,n+t,Ur).getUint32(0,!0),o=new Uint8Array(r,n,t);if(s!==Oc(o))throw new Error(
"checksum mismatch");return o}computeEncodedSize(e){return e+Ur}},Br=class a{kind="bytes_to_bytes";most;constructor(e){this.
most=e}static fromConfig(e,{shape:t}){return new a(Math.min(t.reduce((r,n)=>r*n,Rc),Lc))}encode(){throw new Error("nothi\
ng is written")}async decode(e){let t=new Blob([e]).stream();return ka(t.pipeThrough(new DecompressionStream("gzip")),r=>{
if(r>this.most)throw new Error(`a chunk unpacks to more than ${this.most} bytes`)})}};qe.set("gzip",()=>Promise.resolve(
Br));qe.set("crc32c",()=>Promise.resolve(Dr));function Fc(a,e){return new Promise((t,r)=>{let n=()=>{clearTimeout(s),r(e.
reason)},s=setTimeout(()=>{e.removeEventListener("abort",n),t()},a);e.addEventListener("abort",n,{once:!0})})}async function Nc(a,e){
let t=new AbortController,r=()=>t.abort();e.addEventListener("abort",r,{once:!0});let n=setTimeout(r,Pa);try{e.throwIfAborted();
let{status:s,body:o}=await fetch(a,{signal:t.signal}),i=await ka(s===La?o:null,()=>{clearTimeout(n),n=setTimeout(r,Pa)});
return[s,i]}finally{t.abort(),clearTimeout(n),e.removeEventListener("abort",r)}}async function Ra(a,e){for(let t=0;;t+=1){
let r="no server answers";try{let[n,s]=await Nc(a,e);if(n===La)return s;if(Ac.includes(n))return;if(r=`the server answer\
s ${n}`,n<_c&&n!==Tc)throw new $("broken",r)}catch(n){if(e.throwIfAborted(),n instanceof $)throw n}if(t===_a.length)throw new $(
"unreachable",r);await Fc(_a[t],e)}}var ar=class{url;described;shards=new Map;constructor(e,t){this.url=e,this.described=
t}get=async(e,t)=>e.endsWith("/zarr.json")?this.description(e):this.object(e,t?.signal);getRange=async(e,t,r)=>{let n=this.
shards.get(e)??this.object(e,r?.signal);this.shards.set(e,n);let s=await n;return"suffixLength"in t?s?.subarray(-t.suffixLength):
s?.subarray(t.offset,t.offset+t.length)};async object(e,t=new AbortController().signal){let r=await Ra(this.url+e,t);if(!r)
throw new $("missing",`${e} is missing`);return r}description(e){let t=this.described.get(e);if(t)return t;let r=Ra(this.
url+e,new AbortController().signal);return this.described.set(e,r),r.catch(()=>this.described.delete(e)),r}};function Oa(a){
if(a instanceof $)return a;let e=a instanceof q&&!a.found?"missing":"broken";return new $(e,a instanceof Error?a.message:
String(a))}var or=class{url;described=new Map;constructor(e){this.url=e.replace(/\/+$/,"")}async attributes(){let e=new ar(
this.url,this.described);return(await Q.v3(nr(e),{kind:"group"})).attrs}async array(e){let t=new ar(this.url,this.described),
r=await Q.v3(nr(t).resolve(e),{kind:"array"});if(!r.is("number"))throw new $("broken",`${e} has no numbers`);return r}};var Ic=64,Cc=32,ir=4096,Vc=2**28,Uc=["padded","unit","open","nearest","normal","rays"],Dc={missing:"it is not in the sto\
re, or the store is not public.",broken:"its data in the store are corrupt.",unreachable:"the store does not answer. The\
 server or the network may be down, or the server does not allow this page to read it (CORS)."},Bc=["format","fingerprin\
t","parameter","lines"],ve=(a,e)=>Number.isInteger(a)&&Number(a)>0&&Number(a)<=e,j=(a,e)=>Array.isArray(a)&&a.every(Number.
isFinite)&&(e??a.length)===a.length,Hc=(a,e)=>j(a,e)&&a.every(Number.isInteger);function zc({nodes:a,longest:e=0,poles:t=[]}){
return Number.isFinite(e)&&t.length<=2&&t.every(({component:r,line:n,inward:s,near:o,plane:i})=>[0,1].includes(r)&&r===t[0].
component&&n===(s>0?0:a[1-r]-1)&&[1,-1].includes(s)&&ve(o,ir)&&j(i,6))}function Gc(a,{geometry:e,slices:t}){let{geometry:r,
slices:n}=a,{shape:s,rows:o,columns:i}=r,{trace:c}=n;if(!(j(s,2)&&s.every(h=>ve(h,ir)&&h>1)&&[o,i].every(({before:h,size:u},m)=>Number.
isInteger(h)&&ve(u,ir)&&h>=0&&h+s[m]<=u)&&Number.isInteger(r.levels)&&r.levels>=0&&2**r.levels<=Math.max(o.size,i.size)&&
r.triangles===e.triangles&&r.planar===e.planar&&Number.isFinite(r.extent)&&j(r.periodic.map(Number),2)&&j(r.center,3)&&j(
r.frame,9)&&ve(n.count,Ic)&&[2,4].includes(n.channels)&&j(n.lags)&&ve(n.lags.length,Cc)&&n.sides===t.sides&&j(n.extra)&&
n.extra.every(h=>Number.isInteger(h)&&h>=0&&h<n.count)&&j([n.unit,n.cell,n.critical])&&(!c||c.parts.every(h=>Uc.includes(
h))&&j(c.nodes,2)&&c.nodes.every((h,u)=>ve(h,ir)&&c.drawn[u]+s[u]<=h)&&Hc([...c.first,...c.drawn],4)&&c.drawn.every(h=>h>=
0)&&j(c.closed.map(Number),2)&&j([...c.offset,...c.middle,c.unit,c.pace,c.rest],12)&&zc(c)&&(!c.timed||j([c.timed.unit,c.
timed.speed],2)))))throw new Error("the header of a tile does not match the page")}function Na({geometry:a,slices:e}){let{
shape:t,planar:r}=a,{trace:n,count:s,channels:o,extra:i}=e,c=(p,...f)=>[...p,...f].reduce((d,g)=>d*g,1),l=[a.rows.size,a.
columns.size],h=n?.nodes??[],u={cells:[Uint8Array,[c(t.map(p=>p-1))]],normal:[Int16Array,[c(t,3)]],scalars:[Float32Array,
[c(t)]]};if(n){u.unit=[Uint16Array,[c(h)]],u.padded=[Float32Array,[c(h.map(f=>f+2),3)]],u.open=[Uint8Array,[c(h)]],u.nearest=
[Int16Array,[c(h,2)]];let p=n.poles??[];u.rays=[Float32Array,[c(p.slice(0,1).map(f=>h[f.component]),2,p.length)]],u.flow=
[Uint16Array,n.uncertain?[c(h,5)]:[c(h,3),c(h,4)]]}else u.position=[Float32Array,[c(t,3)]],u.slices=[Uint16Array,[c(l,s,
o)]],u.extra=[Uint16Array,[c(l,i.length)]];let m=n?["mesh",...n.parts]:["mesh","position",...r?[]:["normal"]];return{sizes:u,
needed:m}}function Hr(a,e,t){let{sizes:r}=Na(e),n=e.geometry.shape.map(s=>Math.ceil((s-1)/t));for(let{name:s,data:o,shape:i}of a){
let c=r[s.split("/")[0]];if(!(c?o instanceof c[0]&&c[1].includes(o.length):s==="mesh"&&o instanceof Float32Array&&i.length===
3&&i[0]===n[0]&&i[1]===n[1]&&o.length===i[0]*i[1]*i[2]))throw new Error(`the part "${s}" of a tile has a wrong size`)}}function Wc(a,{
geometry:e,slices:t},r){let[n,s]=e.shape,[o,{drawn:i,nodes:c}={drawn:[0,0],nodes:[0,0]}]=[a.shape[2],t.trace],l=new Float32Array(
n*s);for(let h=0;h<l.length;h+=1){let u=(Math.floor(h/s)+i[0])*c[1]+h%s+i[1];l[h]=r*Re[Number(a.data[o*(u+1)-1-Number(t.
trace?.uncertain??!1)])]}return{name:"",data:l,shape:[n,s],digest:`${a.digest} speed`}}function Fa(a){let e=Oa(a);return e.
fault==="other"||e.detail!==e.message?e:new $(e.fault,Dc[e.fault],e.message)}var cr=class{hasSteps=!0;atOnce=6;memory=18e7;header;told;url;store;headers=new Map;opening=null;constructor(e,t){
let r=e.store;if(!r)throw new Error("the page does not say where its store is");this.header=e,this.told=r,this.url=new URL(
r.url,t),this.store=new or(this.url.href)}open(){return this.opening??=this.compare().catch(e=>{let t=Fa(e);throw t.fault===
"unreachable"&&(this.opening=null),t}),this.opening}async compare(){let{url:e}=this.told;if(!/^https?:/.test(this.url.protocol)){
let n=`This page reads its store from ${e} in the same folder, which browsers do not allow when the page is opened as a \
file: open it from a web server.`;throw new $("other",n)}let t=(await this.store.attributes()).flowtex;if(Bc.every(n=>t?.[n]===
this.told[n]))return;let r=`The store at ${e} does not match this page: it has another flow, other paths or another vers\
ion: export the page again.`;throw new $("other",r)}load=async(e,t,r,n)=>{let s=e??[this.told.depth,0,0],o=G(s);return this.
loaded(r,async i=>{let c=t.filter(d=>!n(`slices/${d}`)&&!n(`flow/${d}`)),l=e?n("header")&&!c.length?this.headers.get(o):
void 0:this.header,h=l===void 0?this.surface(s,i):{header:l,parts:[]},u=new Map(c.map(d=>[d,this.flow(s,d,i)])),m=[...u.
values()],p=async()=>{let{header:d,parts:g}=await h;if(e&&this.headers.set(o,d),!d)return g;let[b,...y]=await Promise.all(
[this.values(s,d,t,n,i,u),...m]);if(Hr(y.flat(),d,this.header.mesh.tileCells),!y.every(x=>x.length))throw new Error(`til\
e ${o} has no flow`);return[...g,...y.flat(),...b]},[f]=await Promise.all([p(),...m]);return e?f.map(d=>({...d,name:`til\
e/${o}/${d.name}`})):f})};async loaded(e,t){let r=new AbortController;e.addEventListener("abort",()=>r.abort(),{once:!0});
try{return await this.open(),e.throwIfAborted(),await t(r.signal)}catch(n){throw e.throwIfAborted(),Fa(n)}finally{r.abort()}}async file(e,t,r,n){
let s=await this.store.array(`${t[0]}/${e}`),o=async f=>{let{data:d}=await s.getChunk([...r,f],{signal:n});if(!(d instanceof
Uint8Array))throw new Error(`${s.path} is empty`);return d},i=await o(0),[c,l]=pr(i),h=c.reduce((f,{bytes:d})=>f+d,l);if(!ve(
h,Vc))throw new Error(`a file of ${s.path} has a wrong size`);let u=new Uint8Array(Math.ceil(h/i.length)*i.length);u.set(
i);for(let f=1;f*i.length<h;f+=1)u.set(await o(f),f*i.length);let m=new Map;for(let f of Qr(u.buffer)){let[d,g]=me(f.name)??
["",f.name];if(d&&d!==G(t))throw new Error(`in place of tile ${G(t)} is ${d}`);m.set(g,{...f,name:g})}if(new TextDecoder().
decode(m.get("of")?.data)!==this.told.fingerprint)throw new Error(`tile ${G(t)} belongs to another flow`);return m.delete(
"of"),m}async surface(e,t){let r=await this.file("surface",e,[e[1],e[2]],t),n=this.tileHeader(r.get("header"));if(r.delete(
"header"),n){let i=Na(n).needed.filter(c=>!r.has(c));if(i.length)throw new Error(`a tile has no ${i.join(", ")}`);Hr([...r.
values()],n,this.header.mesh.tileCells)}let s=new TextEncoder().encode(JSON.stringify(n)),o={name:"header",data:s,shape:[
s.length],digest:`${this.told.fingerprint} ${G(e)} header`};return{header:n,parts:[o,...r.values()]}}tileHeader(e){let t=JSON.
parse(new TextDecoder().decode(e?.data));if(t===null)return null;let{steps:r,times:n,timeUnit:s,dates:o,pace:i}=this.header.
slices;return Gc(t,this.header),{...t,slices:{...t.slices,steps:r,times:n,timeUnit:s,dates:o,pace:i}}}async flow(e,t,r){
let n=this.told.steps[t];return[...(await this.file("flow",e,[n,e[1],e[2]],r)).values()].map(o=>{let[i,c]=o.name.split("\
/");if(Number(c)!==n)throw new Error(`in place of step ${n} is ${o.name}`);return{...o,name:`${i}/${t}`}})}async values(e,t,r,n,s,o){
let i=new Map;for(;;){let{name:c,steps:l,number:h}=this.header.scalars,m=(l>1?r:[0]).map(d=>h?`scalars/${d}/${h}`:`scala\
rs/${d}`),p=c===null?[]:m.filter(d=>!n(d)&&!i.has(d));if(!p.length)return[...i.values()];let f=await Promise.all(p.map(async d=>{
let g=l>1?X(d):0;if(!h&&this.told.derivesSpeed&&t.slices.trace){let[v]=await(o.get(g)??this.flow(e,g,s));return{...Wc(v,
t,this.header.speed.typical),name:d}}let b=l>1?this.told.steps[g]:0,x=(await this.file("values",e,[b,e[1],e[2],h],s)).get(
`scalars/${b}/${h}`);if(!x)throw new Error(`tile ${G(e)} has no values of step ${b}`);return{...x,name:d}}));Hr(f,t,this.
header.mesh.tileCells);for(let d of f)i.set(d.name,d)}}};var $c=4096,jc=4,Ia=32,Yc=.25,Xc=1e4,Ca=class{id;type="custom";renderingMode="2d";options;map=null;gl=null;programs=null;array=null;scene=null;pictures=[];look="";globe=!1;shownOpacity=1;close=null;asked=Promise.
resolve(null);own;colours={};constructor(e){this.options=e,this.own={...e.settings},this.id=e.id}onAdd(e,t){this.onRemove(),
this.map=e,this.gl=t;let r={context:t,counted:n=>n,free:()=>{}};this.programs=new Se(r),this.array=t.createVertexArray(),
this.open(t).catch(n=>this.failed(n.message,""))}onRemove(){let{gl:e}=this;for(let t of this.pictures)t.dispose(e);this.
close?.then(t=>t.dispose()),this.close=null,e?.deleteVertexArray(this.array),this.programs?.dispose(),this.map=this.gl=this.
scene=null,[this.pictures,this.look]=[[],""]}async open(e){let{scene:t,opacity:r}=this.options,n=new URL(typeof t=="stri\
ng"?t:"",location.href).href,{headers:s,parts:o}=typeof t=="string"?await qc(n):t;if(this.gl!==e)return;let i=Kc(s[0]),c=new zt(
i,o.flatMap(([f,d,g])=>f?[]:[[d,g]]),new Map,new Map),l=i.store?new cr(i,n):c,h={header:i,settings:{...i.settings,...i.own,
...this.own},player:new ht};this.shownOpacity=r??s[0].opacity;let u=async(f,d)=>{let g=!0,b=new It(f,{...h,source:l,isComing:()=>g});
d(b);for(let y of c.parts){let x=await c.kept(y);if(b.lifetime.isOver)break;b.setPart(x)}return g=!1,Object.keys(this.colours).
length&&b.chooseColours(this.colours),b},m=()=>{let f=null;return u(this.hostOf(()=>f),d=>this.pictures.push(f=new Ht(e,
d)))},p=await m();this.gl===e&&(this.scene={...h,add:m,make:u,mercator:new Dt(i.earth,p.parts.get("lonlat"),i.ends)},p.requests.
open(),this.options.onOpen?.(),this.map?.triggerRepaint())}hostOf=e=>({isHeld:()=>this.map?.isMoving()??!1,painted:t=>{e()?.
painted(t),this.map?.triggerRepaint()},advanced:()=>this.options.onTime?.(this.time),failed:(t,r)=>this.failed(t,r)});get time(){
let{varies:e=!1,time:t=0,clock:r=0}=this.scene?.player??{};return e?t:r}set time(e){let{player:t}=this.scene??{};t?.varies?
t.seek(e):t&&(t.clock=e),this.change()}get times(){return this.scene?.header.slices.times??[]}get bounds(){let{mercator:e}=this.
scene??{};if(!e)return null;let{box:t}=e;return[e.lngLatOf(t.slice(0,2)),e.lngLatOf(t.slice(2))]}get opacity(){return this.
shownOpacity}set opacity(e){this.shownOpacity=e,this.map?.triggerRepaint()}play(){let{player:e,settings:t}=this.scene??{};
!e||!t||(!e.varies&&t.motion==="off"&&(t.motion="speed"),e.start(),this.change())}pause(){this.scene&&(this.scene.player.
playing=!1),this.change()}set(e){Object.assign(this.own,e),Object.assign(this.scene?.settings??{},e),this.change()}setColours(e){
Object.assign(this.colours,e);for(let{view:t}of this.pictures)t.chooseColours(e)}change(){for(let{view:e}of this.pictures)
e.change()}async pointAt(e){let{mercator:t,header:r}=this.scene??{};if(!t||!r)return null;let n=[...t.positionOf(ge(e)),
r.geometry.center[2]],s=this.pictures.filter(({isUsed:c})=>c).map(({view:c})=>c);await Ua(()=>s.every(({painter:c})=>c.canPick&&
c.shown));let o=s.map(c=>this.pointIn(c,n)).find(Boolean)??null;if(o&&!r.pyramid)return o;this.asked=this.asked.then(()=>this.
pointClose(n)).catch(()=>null);let i=await this.asked;return i&&{...i,path:o?.path??i.path}}pointIn(e,t){let{camera:r,parts:n,
settings:s}=e,{mercator:o}=this.scene??{},i=r?.project(t)??[2,2],c=Math.max(...i.map(Math.abs))>1?null:e.find(i[0],i[1]),
l=e.painter.shown;if(!o||!r||!c||!l)return null;let h=c.point.position,u={scene:c.layer.scene,moment:l,place:c.place,position:h},
[m,p]=xs(u,n.get("lonlat"))??[NaN,NaN],{path:f}=fs(u,s,r,e.rows);return{eastward:m,northward:p,values:c.point.values,path:f.
map(d=>o.lngLatOf(d))}}async pointClose(e){let{scene:t}=this;if(!t)return null;let r=!1,n={...this.hostOf(()=>null),painted:()=>{
r=!0},advanced:()=>{}},s=await(this.close??=t.make(n,f=>f.requests.open())),{box:o}=t.mercator,{pyramid:i,geometry:c}=t.
header,l=Yc*(o[2]-o[0])/(i?.shapes[0]??c.shape)[1],[h,u,m]=e,p={up:[0,1,0],view_angle:30,position:[h,u,m+l],focal_point:e,
parallel:!0,parallel_scale:l};return s.isVisible=!0,s.look(p,Ia,Ia,1),await Ua(()=>r&&s.painter.canPick&&!s.tiles?.pending&&
!s.tiles?.missing.length),s.isVisible=!1,this.pointIn(s,e)}failed(e,t){this.map?.fire("error",{error:new Error([e,t].filter(
Boolean).join(" "))})}render(e,t){let{map:r,scene:n,programs:s,array:o,opacity:i}=this;if(!r||!n||!s)return;let c=t.defaultProjectionData.
projectionTransition>0;this.follow(r,n,c);let[l,h]=[r.getZoom(),r.getCenter()],u=this.pictures.filter(({isUsed:d})=>d),{
shaderData:m,getProjectionData:p}=t,f={gl:e,programs:s,array:o,shaderData:m,getProjectionData:p,zoom:l,center:h,globe:c,
opacity:i};for(let d of u){let g=d.draw({...f,mercator:n.mercator,isRepeated:u.length===1});typeof g=="string"&&g?this.failed(
"The flow cannot be drawn on the map.",g):g!==!0&&r.triggerRepaint()}}follow(e,{mercator:t,header:r,add:n},s){let{what:o,
ratio:i,text:c}=Va(e,s);if(c===this.look)return;let l=t.look(o,r.geometry.center[2]);l.length>this.pictures.length&&n(),
[0,1].forEach(h=>{let{width:u=1,height:m=1}=l[h]??{},p=Math.sqrt(jc*o.width*o.height/(u*m));this.pictures[h]?.follow(l[h],
Math.min(i,i*p,$c/Math.max(u,m)))}),this.look=c,this.globe=s}get isComplete(){let{map:e,pictures:t}=this;return!e||!this.
scene||!t.every(r=>r.isComplete)?!1:this.look===Va(e,this.globe).text}};function Va(a,e){let{clientWidth:t,clientHeight:r}=a.
getCanvas(),n={center:a.unproject([t/2,r/2]),width:t,height:r,zoom:a.getZoom(),bearing:a.getBearing(),pitch:a.getPitch(),
fov:a.getVerticalFieldOfView(),globe:e},s=a.getPixelRatio();return{what:n,ratio:s,text:JSON.stringify([n,s])}}async function Ua(a){
let e=performance.now()+Xc;for(;!a()&&performance.now()<e;)await new Promise(requestAnimationFrame)}async function qc(a){
let e=await fetch(a);if(!e.ok)throw new Error(`the scene ${a} cannot be read: the server answers ${e.status}`);return await e.
json()}function Kc(a){let{earth:e}=a,t={land:null,coastlines:!1,graticule:!1};return{...a,ends:Jc(a),background:[0,0,0],
opacity:1,earth:e&&{...e,...t}}}function Jc({earth:a,geometry:e,slices:t}){let{map:r}=a??{};if(!a||!r||!e.periodic[1])return null;
let n=.5*(r[0]+r[2]),s=.5*(t.trace?.offset[3]??2*Math.PI*a.radius);return[n-s,n+s]}export{Ca as FlowtexLayer};
